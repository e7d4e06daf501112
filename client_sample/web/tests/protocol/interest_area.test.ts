import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { interestArea } from '../../src/protocol/interest_area';

interface GoldenCase {
  shape: { cells: number; voxel_m: number; height_range_m: [number, number] };
  view: { position: [number, number, number]; near_m: number; far_m: number; lod_bias: number };
  keys: [number, number, number, number][];
}

const golden = JSON.parse(
  readFileSync(new URL('../../../../tests/golden/interest_area.json', import.meta.url), 'utf8'),
) as GoldenCase[];

test('the golden file has cases', () => expect(golden.length).toBeGreaterThan(0));

test.each(golden.map((each, i) => [i, each] as const))('the interest area of golden case %i is the server\'s', (_, each) => {
  const [x, y, z] = each.view.position;
  const view = { position: { x, y, z }, nearM: each.view.near_m, farM: each.view.far_m, lodBias: each.view.lod_bias };
  const shape = {
    cells: each.shape.cells,
    voxelM: each.shape.voxel_m,
    heightLowM: each.shape.height_range_m[0],
    heightHighM: each.shape.height_range_m[1],
  };
  const found = interestArea(view, shape).map((key) => `${key.lod}/${key.x}/${key.y}/${key.z}`);
  expect(found.sort()).toEqual(each.keys.map((key) => key.join('/')).sort());
});
