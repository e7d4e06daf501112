import { expect, test } from 'vitest';
import { placeInPeriod } from '../../src/render/shared_uniforms';
import { placeFromQuery, queryOfPlace } from '../../src/ui/place';

test('a shared place is read back', () => {
  const query = queryOfPlace('?hud=0&far=9000', [1e9 + 0.5, 80, -12.25], 45, -10);
  const place = placeFromQuery(query);
  expect(place.at).toEqual([1000000000.5, 80, -12.3]);
  expect([place.yaw, place.pitch, place.farM, place.hud]).toEqual([45, -10, 9000, false]);
});

test.each(['at=1,2', 'at=1,2,x', 'at=,,', 'at=1,2,NaN', 'at=1,2,Infinity'])('%s is no place', (query) => {
  expect(placeFromQuery(`?${query}`).at).toBeNull();
});

test('chunks come as Draco unless the query asks for meshes', () => {
  expect(placeFromQuery('?far=900').formats).toEqual(['drc']);
  expect(placeFromQuery('?format=obj').formats).toEqual(['drc']);
  expect(placeFromQuery('?format=mesh').formats).toEqual(['mesh', 'drc']);
});

test('shadows are drawn unless the query turns them off', () => {
  expect(placeFromQuery('?far=900').shadows).toBe(true);
  expect(placeFromQuery('?shadows=0').shadows).toBe(false);
});

test('values beyond their limits are brought to them', () => {
  expect(placeFromQuery('?far=1e99').farM).toBe(32_768);
  expect(placeFromQuery('?pitch=-1000').pitch).toBe(-89);
});

test('a place modulo the texture period loses no centimetre at 10^9 m', () => {
  expect(placeInPeriod(1e9 + 0.125)).toBe(1e9 % 16_384 + 0.125);
  expect(placeInPeriod(-0.5)).toBe(16_383.5);
});
