import { describe, expect, it } from 'vitest';
import { bestYaw, looksAround } from '../../src/ui/first_look';

const sunInTheEast = 90;
const heightsOf = (height: (x: number, z: number) => number): number[] =>
  looksAround(0, 0).flatMap((look) => look.places.map(([x, z]) => height(x, z)));

describe('first look', () => {
  it('turns to the only land there is', () => {
    expect(bestYaw(looksAround(0, 0), heightsOf((_, z) => (z > 500 ? 300 : -200)), sunInTheEast)).toBe(180);
    expect(bestYaw(looksAround(0, 0), heightsOf((x) => (x < -500 ? 300 : -200)), 0)).toBe(90);
  });

  it('looks across the light where land is the same all around', () => {
    expect(bestYaw(looksAround(0, 0), heightsOf(() => 100), sunInTheEast) % 180).toBe(0);
    expect(bestYaw(looksAround(0, 0), heightsOf(() => 100), 0) % 180).toBe(90);
  });

  it('prefers the mountains to the plain', () => {
    expect(bestYaw(looksAround(0, 0), heightsOf((_, z) => (z < -1500 ? 1100 : 20)), sunInTheEast)).toBe(0);
  });
});
