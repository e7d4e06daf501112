import { expect, test } from 'vitest';
import { createBody, fly, jump, turn, walk } from '../../src/ui/motion';

const still = { right: 0, up: 0, ahead: 0, hurried: false, speedSteps: 0 };
const level = (heightM: number) => () => ({ heightM, up: 1 });

test('a walker falls to the ground and stands on it', () => {
  const body = createBody(0, 30, 0, 0, 0);
  for (let i = 0; i < 400; ++i) walk(body, still, level(12), 1 / 60);
  expect(body.y).toBeCloseTo(13.75, 3);
});

test('nobody falls where the ground has not arrived', () => {
  const body = createBody(0, 30, 0, 0, 0);
  for (let i = 0; i < 60; ++i) walk(body, still, () => null, 1 / 60);
  expect(body.y).toBe(30);
});

test('a jump leaves the ground and returns to it', () => {
  const body = createBody(0, 13.75, 0, 0, 0);
  body.walking = true;
  jump(body, level(12));
  let highest = 0;
  for (let i = 0; i < 200; ++i) {
    walk(body, still, level(12), 1 / 60);
    highest = Math.max(highest, body.y);
  }
  expect(highest).toBeGreaterThan(14.5);
  expect(body.y).toBeCloseTo(13.75, 3);
});

test('walking ahead at yaw 0 goes along -z and follows a slope', () => {
  const body = createBody(0, 1.75, 0, 0, 0);
  const slope = (_: number, z: number) => ({ heightM: -z * 0.3, up: 0.96 });
  for (let i = 0; i < 120; ++i) walk(body, { ...still, ahead: 1 }, slope, 1 / 60);
  expect(body.z).toBeLessThan(-7);
  expect(body.y).toBeCloseTo(-body.z * 0.3 + 1.75, 0);
});

test('a wall is not climbed', () => {
  const body = createBody(0, 1.75, 0, 0, 0);
  const wall = (_: number, z: number, ceiling: number) => (z < -2 ? (ceiling > 50 ? { heightM: 50, up: 0.1 } : null) : { heightM: 0, up: 1 });
  for (let i = 0; i < 200; ++i) walk(body, { ...still, ahead: 1 }, wall, 1 / 60);
  expect(body.z).toBeGreaterThan(-2.01);
  expect(body.y).toBeCloseTo(1.75, 3);
});

test('flying follows the look, and the look cannot turn over', () => {
  const body = createBody(0, 0, 0, 0, 0);
  turn(body, Math.PI / 2, 9);
  expect(body.pitch).toBeLessThan(Math.PI / 2);
  body.pitch = 0;
  for (let i = 0; i < 60; ++i) fly(body, { ...still, ahead: 1 }, 1 / 60);
  expect(body.x).toBeLessThan(-20);
  expect(Math.abs(body.z)).toBeLessThan(1e-6);
});
