// The tilesets against the rules of 3D Tiles 1.1 and glTF 2.0, from the bytes that any client gets: boxes hold the
// decoded vertices, errors halve, availability is true, and gltf-validator has nothing to say.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import draco3d from 'draco3d';
import gltf from 'gltf-validator';
import { request } from '../doors/frame/http.mjs';
import { startServer } from '../doors/frame/server.mjs';
import { chunkPath, manifestOf, surfaceKeys } from '../doors/frame/terrain.mjs';
import { childBox, describedTiles, glbPositions, isSet, readSubtree } from './tileset.mjs';

const folder = '/v1/worlds/default/3dtiles/';
// Anywhere, cliffs and an overhang, far away.
const origins = [[0, 0], [67_499, -30_379], [-69_376, -112_896], [1_000_000_000, -1_000_000_000]];

/// Whole numbers below `count` that are the same in every run.
function sequence(seed) {
  let state = seed;
  return (count) => {
    state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
    return Math.floor((state / 2 ** 32) * count);
  };
}

describe('3D Tiles', () => {
  let server;
  let http;
  let decoder;
  let manifest;
  const below = (url) => request(http, folder + url);
  const document = async (query) => JSON.parse((await below(`tileset.json${query}`)).body.toString());
  before(async () => {
    server = await startServer();
    http = server.ready.http;
    decoder = await draco3d.createDecoderModule({});
    manifest = await manifestOf(server);
  });
  after(() => server?.stop());

  /// Follows a way down from an implicit root through its subtrees; gives the tiles on it with their boxes.
  async function wayDown(root, random) {
    const { availableLevels, subtreeLevels, subtrees } = root.implicitTiling;
    const tiles = [];
    let tile = { level: 0, x: 0, y: 0, box: root.boundingVolume.box };
    let subtree = null;
    for (;;) {
      const inSubtree = tile.level % subtreeLevels;
      if (inSubtree === 0) {
        const answer = await below(at(subtrees.uri, tile));
        assert.equal(answer.status, 200, `the parent said that subtree ${at(subtrees.uri, tile)} is there`);
        subtree = readSubtree(answer.body);
        subtree.corner = { x: tile.x, y: tile.y };
      }
      const morton = mortonOf(tile.x - subtree.corner.x * 2 ** inSubtree, tile.y - subtree.corner.y * 2 ** inSubtree);
      const index = (4 ** inSubtree - 1) / 3 + morton;
      assert.ok(isSet(subtree, subtree.json.tileAvailability, index), `tile ${JSON.stringify(tile)} is available`);
      tiles.push({ ...tile, hasContent: isSet(subtree, subtree.json.contentAvailability[0], index) });
      const goesOn = tile.level + 1 < availableLevels;
      if (inSubtree === subtreeLevels - 1) {
        assert.equal(isSet(subtree, subtree.json.childSubtreeAvailability, 4 * morton), goesOn);
      } else {
        assert.equal(isSet(subtree, subtree.json.tileAvailability, 4 * index + 1), goesOn, 'availability ends with the levels');
      }
      if (!goesOn) return tiles;
      const x = 2 * tile.x + random(2);
      const y = 2 * tile.y + random(2);
      tile = { level: tile.level + 1, x, y, box: childBox(tile.box, x % 2, y % 2) };
      if (tile.level % subtreeLevels === 0) subtree = null;
    }
  }
  const at = (template, tile) => template.replace('{level}', tile.level).replace('{x}', tile.x).replace('{y}', tile.y);
  const mortonOf = (x, y) => {
    let out = 0;
    for (let bit = 0; bit < 16; ++bit) out += ((Math.floor(x / 2 ** bit) % 2) + 2 * (Math.floor(y / 2 ** bit) % 2)) * 4 ** bit;
    return out;
  };

  /// Fetches a tile's content, which must be valid glTF inside the tile's box. `stepM`: rounding of floats far away.
  async function checkContent(url, box, stepM) {
    const answer = await below(url);
    assert.equal(answer.status, 200, url);
    await checkGltf(answer.body, url);
    const half = [box[3], box[7], box[11]];
    let vertices = 0;
    for (const [x, y, z] of glbPositions(decoder, draco3d, answer.body)) {
      for (const [axis, value] of [x, -z, y].entries()) {
        assert.ok(Math.abs(value - box[axis]) <= half[axis] + stepM, `${url}: ${[x, -z, y]} is outside ${box}`);
      }
      vertices += 1;
    }
    assert.ok(vertices > 0, `${url}: a column has a surface`);
  }

  async function checkGltf(bytes, what) {
    const report = await gltf.validateBytes(new Uint8Array(bytes), { maxIssues: 20 });
    const found = report.issues.messages.filter((issue) => issue.severity <= 1);
    assert.deepEqual(found, [], what);
  }

  test('around a place: boxes hold what they should, errors halve, every level has its content', async () => {
    const random = sequence(11);
    for (const origin of origins) {
      const tileset = await document(`?origin=${origin}&km=4`);
      const trees = [];
      for (const { parent, tile } of describedTiles(tileset.root)) {
        assert.equal(tile.geometricError, parent.geometricError / 2);
        for (let axis = 0; axis < 3; ++axis) {
          const rim = Math.abs(tile.boundingVolume.box[axis] - parent.boundingVolume.box[axis]) + tile.boundingVolume.box[3 + 4 * axis];
          assert.ok(rim <= parent.boundingVolume.box[3 + 4 * axis] + 1e-6, 'a box holds its children');
        }
        if (tile.implicitTiling) trees.push(tile);
      }
      const [spelledOut] = tileset.root.children;
      await checkContent(spelledOut.content.uri, spelledOut.boundingVolume.box, 1e-3);
      for (let i = 0; i < 2; ++i) {
        const tree = trees[random(trees.length)];
        assert.equal(tree.geometricError, manifest.voxel_m * 2 ** (tree.implicitTiling.availableLevels - 1));
        for (const tile of await wayDown(tree, random)) {
          assert.equal(tile.hasContent, true);
          await checkContent(at(tree.content.uri, tile), tile.box, 1e-3);
        }
      }
    }
  });

  test('of the whole world: content where there are chunks of its size, and 404 above', async () => {
    const random = sequence(12);
    const { root } = await document('');
    for (let i = 0; i < 2; ++i) {
      const tiles = await wayDown(root, random);
      assert.equal(tiles.length, root.implicitTiling.availableLevels);
      for (const tile of tiles) {
        const url = at(root.content.uri, tile);
        const lod = root.implicitTiling.availableLevels - 1 - tile.level;
        assert.equal(tile.hasContent, lod <= manifest.lod_max, url);
        // A float at 10^9 m is whole steps of 64 m wide; boxes are doubles.
        if (tile.hasContent) await checkContent(url, tile.box, 1e-3);
        else assert.equal((await below(url)).status, 404, url);
      }
    }
  });

  test('and chunks of every LOD are glTF without an error or a warning', async () => {
    const random = sequence(13);
    let assets = 0;
    for (let lod = 0; lod <= manifest.lod_max; ++lod) {
      const places = Array.from({ length: 6 }, () => [random(4e6) - 2e6, random(4e6) - 2e6]);
      for (const key of await surfaceKeys(http, manifest, lod, places)) {
        const answer = await request(http, `${chunkPath(manifest, key, 'glb')}?origin=${places[0][0]},0,${places[0][1]}`);
        if (answer.status === 204) continue;
        await checkGltf(answer.body, JSON.stringify(key));
        assets += 1;
      }
    }
    assert.ok(assets >= 60, `${assets} assets`);
  });
});
