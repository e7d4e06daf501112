// What the server says about its worlds over plain HTTP, checked once, here.

import type { WorldShape } from './chunk_key';

export interface WorldManifest {
  name: string;
  shape: WorldShape;
  colours: (string | number)[]; // of materials, in the order of their indices
}

async function json(url: URL): Promise<unknown> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url.pathname} answered ${response.status}`);
  return response.json();
}

function field(value: unknown, name: string): unknown {
  return typeof value === 'object' && value !== null ? (value as Record<string, unknown>)[name] : undefined;
}

function finite(value: unknown, what: string): number {
  if (typeof value !== 'number' || !Number.isFinite(value)) throw new Error(`the manifest has no number ${what}`);
  return value;
}

/// The name of the world to show: `asked` if there is one, else the server's first.
export async function chooseWorld(base: URL, asked: string | null): Promise<string> {
  if (asked !== null) return asked;
  const answer = await json(new URL('v1/worlds', base));
  const list = Array.isArray(answer) ? answer : field(answer, 'worlds');
  const first: unknown = Array.isArray(list) ? list[0] : undefined;
  const name = typeof first === 'string' ? first : field(first, 'name');
  if (typeof name !== 'string') throw new Error('the server names no world');
  return name;
}

export async function fetchManifest(base: URL, world: string): Promise<WorldManifest> {
  const manifest = await json(new URL(`v1/worlds/${encodeURIComponent(world)}`, base));
  const range = field(manifest, 'height_range_m');
  if (!Array.isArray(range)) throw new Error('the manifest has no height_range_m');
  const materials = field(manifest, 'materials');
  const colours = (Array.isArray(materials) ? materials : []).map((material: unknown) => field(material, 'colour'));
  return {
    name: world,
    shape: {
      cells: finite(field(manifest, 'chunk_cells'), 'chunk_cells'),
      voxelM: finite(field(manifest, 'voxel_m'), 'voxel_m'),
      heightLowM: finite(range[0], 'height_range_m[0]'),
      heightHighM: finite(range[1], 'height_range_m[1]'),
    },
    colours: colours.filter((colour): colour is string | number => typeof colour === 'string' || typeof colour === 'number'),
  };
}

/// A standing place near (x, z), metres; null when the server knows none.
export async function fetchSpawn(base: URL, world: string, x: number, z: number): Promise<[number, number, number] | null> {
  try {
    const answer = await json(new URL(`v1/worlds/${encodeURIComponent(world)}/spawn?near=${x},${z}`, base));
    const place = field(answer, 'position') ?? answer;
    const at = Array.isArray(place)
      ? place
      : [field(place, 'x'), field(place, 'y') ?? field(place, 'height_m'), field(place, 'z')];
    return at.length === 3 && at.every(Number.isFinite) ? (at as [number, number, number]) : null;
  } catch {
    return null; // a server without this route still has a world to look at
  }
}
