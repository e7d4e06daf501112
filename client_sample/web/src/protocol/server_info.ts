// What the server says about its worlds over plain HTTP, checked once, here.

import type { WorldShape } from './chunk_key';
import { authorization, pageToken } from './join_token';

/// How the tiles of the map route lie; see SPEC.md, "Map tiles".
export interface MapScheme {
  tilePixels: number;
  zoomMax: number;
  pixelM: number; // metres a pixel at zoom 0; halved by every zoom
  tileLimit: readonly number[]; // by zoom: coordinates are -limit .. limit - 1
  layers: readonly string[]; // what a tile can show, the first of them by itself
}

/// What is known of a place, for people.
export interface GroundFacts {
  heightM: number;
  text: string;
}

export interface WorldManifest {
  name: string;
  map: MapScheme | null; // of a server without the map route
  shape: WorldShape;
  colours: (string | number)[]; // of materials, in the order of their indices
}

async function json(url: URL, signal?: AbortSignal): Promise<unknown> {
  const response = await fetch(url, { headers: authorization(pageToken), ...(signal && { signal }) });
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

function mapOf(manifest: unknown): MapScheme | null {
  const map = field(manifest, 'map');
  const limit = field(map, 'tile_limit');
  if (!Array.isArray(limit) || !limit.every(Number.isInteger)) return null;
  const layers = field(map, 'layers');
  return {
    tilePixels: finite(field(map, 'tile_pixels'), 'map.tile_pixels'),
    zoomMax: finite(field(map, 'zoom_max'), 'map.zoom_max'),
    pixelM: finite(field(map, 'pixel_m'), 'map.pixel_m'),
    tileLimit: limit as number[],
    layers: Array.isArray(layers) ? layers.filter((layer): layer is string => typeof layer === 'string') : [],
  };
}

export async function fetchManifest(base: URL, world: string): Promise<WorldManifest> {
  const manifest = await json(new URL(`v1/worlds/${encodeURIComponent(world)}`, base));
  const range = field(manifest, 'height_range_m');
  if (!Array.isArray(range)) throw new Error('the manifest has no height_range_m');
  const materials = field(manifest, 'materials');
  const colours = (Array.isArray(materials) ? materials : []).map((material: unknown) => field(material, 'colour'));
  return {
    name: world,
    map: mapOf(manifest),
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

/// The shaded relief goes without a word, so that it is one name for every cache.
export function mapTileUrl(base: URL, world: string, layer: string, zoom: number, x: number, y: number): URL {
  const query = layer === 'shaded' ? '' : `?layer=${encodeURIComponent(layer)}`;
  return new URL(`v1/worlds/${encodeURIComponent(world)}/map/${zoom}/${x}/${y}.png${query}`, base);
}

export async function fetchMapTile(url: URL, signal: AbortSignal): Promise<ImageBitmap> {
  const response = await fetch(url, {
    headers: authorization(pageToken),
    signal,
  });
  if (!response.ok) throw new Error(`a map tile answered ${response.status}`);
  return createImageBitmap(await response.blob());
}

const kKinds = new Map([
  ['continental', 'land plate'],
  ['oceanic', 'sea plate'],
]);

/// One place of the points route as a line of words; fields a server does not know are left out.
export function groundFacts(point: unknown, material?: string, heightM?: number): GroundFacts {
  const height = heightM ?? finite(field(point, 'height_m'), 'height_m');
  const words = [
    height < 0 ? `sea ${Math.round(-height)} m deep` : `${Math.round(height)} m`,
    String(material ?? field(point, 'material') ?? '').replaceAll('_', ' '),
  ];
  const district = field(point, 'district');
  if (typeof district === 'string') words.push(district);
  const layer = field(point, 'layer');
  if (typeof layer === 'number') words.push(`layer ${layer} of set ${String(field(point, 'layer_set') ?? '?')}`);
  const kind = field(point, 'plate_kind');
  const plate = field(point, 'plate');
  if (plate !== undefined && plate !== null) words.push(`${kKinds.get(String(kind)) ?? `${String(kind)} plate`} ${String(plate)}`);
  const fault = field(point, 'fault_m');
  if (typeof fault === 'number') words.push(`fault ${Math.abs(fault) < 1000 ? `${Math.round(Math.abs(fault))} m` : `${(Math.abs(fault) / 1000).toFixed(1)} km`} away`);
  return { heightM: height, text: words.filter((word) => word !== '').join(' · ') };
}

/// Heights at places (x, z) in metres, up to 1000 of them; none when the server does not say.
export async function fetchHeights(base: URL, world: string, places: readonly (readonly [number, number])[]): Promise<number[]> {
  try {
    const xz = places.map((place) => place.map((metres) => metres.toFixed(1)).join(',')).join(';');
    const points = field(await json(new URL(`v1/worlds/${encodeURIComponent(world)}/points?xz=${xz}`, base)), 'points');
    return (Array.isArray(points) ? points : []).map((point: unknown) => finite(field(point, 'height_m'), 'height_m'));
  } catch {
    return [];
  }
}

async function fetchPoint(base: URL, world: string, x: number, z: number, signal: AbortSignal): Promise<unknown> {
  const answer = await json(new URL(`v1/worlds/${encodeURIComponent(world)}/points?xz=${x},${z}`, base), signal);
  const points = field(answer, 'points');
  return Array.isArray(points) ? (points[0] as unknown) : undefined;
}

/// What is at (x, z), metres; null when the question was withdrawn or the server does not answer it.
export async function fetchGround(base: URL, world: string, x: number, z: number, signal: AbortSignal): Promise<GroundFacts | null> {
  try {
    return groundFacts(await fetchPoint(base, world, x, z, signal));
  } catch {
    return null;
  }
}

type Triple = readonly [number, number, number];

/// What a ray meets and what is known of the place; null for sky, and as fetchGround.
export async function fetchHit(base: URL, world: string, from: Triple, direction: Triple, signal: AbortSignal): Promise<GroundFacts | null> {
  try {
    const hit = await json(new URL(`v1/worlds/${encodeURIComponent(world)}/ray?from=${from.join()}&dir=${direction.join()}`, base), signal);
    const position = field(hit, 'position');
    if (!Array.isArray(position)) return null;
    const [x, y, z] = [finite(position[0], 'x'), finite(position[1], 'y'), finite(position[2], 'z')];
    const facts = groundFacts(await fetchPoint(base, world, x, z, signal), String(field(hit, 'material')), y);
    const away = finite(field(hit, 'distance_m'), 'distance_m');
    return { ...facts, text: `${facts.text} · ${away < 1000 ? `${Math.round(away)} m` : `${(away / 1000).toFixed(1)} km`} away` };
  } catch {
    return null;
  }
}
