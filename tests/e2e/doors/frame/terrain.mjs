// Places in a running world, found by asking it.
import { json, request } from './http.mjs';

/// Chunk keys of LOD `lod` that hold the surface above each of `places` ([x, z] in metres).
export async function surfaceKeys(at, manifest, lod, places) {
  const edge = manifest.chunk_cells * manifest.voxel_m * 2 ** lod;
  const { json: answer } = await json(at, `/v1/worlds/${manifest.name}/points?xz=${places.map((p) => p.join(',')).join(';')}`);
  return answer.points.map((point) => ({
    lod,
    x: Math.floor(point.x / edge),
    y: Math.floor(point.height_m / edge),
    z: Math.floor(point.z / edge),
  }));
}

export function chunkPath(manifest, { lod, x, y, z }, format) {
  return `/v1/worlds/${manifest.name}/chunks/${lod}/${x}/${y}/${z}.${format}`;
}

export function columnPath(manifest, { lod, x, z }) {
  return `/v1/worlds/${manifest.name}/columns/${lod}/${x}/${z}.height`;
}

export function seamPath(manifest, { lod, x, y, z }, face) {
  return `/v1/worlds/${manifest.name}/seams/${lod}/${x}/${y}/${z}/${face}.drc`;
}

export async function manifestOf(server) {
  return (await json(server.ready.http, `/v1/worlds/${server.ready.worlds[0]}`)).json;
}

/// A path of a chunk that has a mesh, near the origin.
export async function meshPath(server, format = 'drc') {
  const manifest = await manifestOf(server);
  for (const [key] of await Promise.all([0, 1, 2].map((lod) => surfaceKeys(server.ready.http, manifest, lod, [[40, 40]])))) {
    const path = chunkPath(manifest, key, format);
    if ((await request(server.ready.http, path)).status === 200) return path;
  }
  throw new Error('no chunk with a surface at 40, 40');
}
