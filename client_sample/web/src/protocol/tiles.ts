// Heightfields and density fields: `.height` and `.density` -> plain arrays. SPEC.md, "Height tiles" and "Density tiles".
// Safe on any bytes: throws on what is no tile, bounded before it allocates.
import { decompress } from 'fzstd';
import type { ChunkKey } from './chunk_key';
import { kChunkLimit, kLodMax, kServerMessageBytesMax } from './limits';

export interface HeightTile {
  key: ChunkKey; // of a column: y is 0
  cells: number;
  stepM: number;
  heights: Int32Array; // (cells + 1)^2 columns in rows along x, in steps above the sea
  ridges: Uint8Array; // 0 (crease) .. 255 (ridge)
  materials: Uint8Array;
}

export interface DensityTile {
  key: ChunkKey;
  cells: number;
  stepM: number;
  densities: Int16Array; // (cells + 1)^3 samples, x fastest, then z, then y; negative in rock; (d + 0.5) * stepM metres
  materials: Uint8Array; // kNoMaterial in the air
}

export const kNoMaterial = 255;
const kHeaderBytes = 24;
const kCellsMax = 62;
const kPlanesMax = 4;
/// 8 cells of 256 steps either way.
const kDensityHeld = 2048;
const kStepsPerCell = 256;

function requireThat(holds: boolean, what: string): asserts holds {
  if (!holds) throw new Error(`not a tile: ${what}`);
}

interface Header {
  view: DataView;
  lod: number;
  cells: number;
  seventh: number;
}

function readHeader(bytes: Uint8Array, magic: string): Header {
  requireThat(bytes.length >= kHeaderBytes && bytes.length <= kServerMessageBytesMax, `${bytes.length} bytes`);
  requireThat([...magic].every((letter, i) => bytes[i] === letter.charCodeAt(0)), 'the first bytes are those of something else');
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  requireThat(view.getUint8(4) === 1, `version ${view.getUint8(4)}`);
  const header = { view, lod: view.getUint8(5), cells: view.getUint8(6), seventh: view.getUint8(7) };
  requireThat(header.lod <= kLodMax, `LOD ${header.lod}`);
  requireThat(header.cells >= 1 && header.cells <= kCellsMax, `${header.cells} cells`);
  return header;
}

function keyOf(lod: number, x: number, y: number, z: number): ChunkKey {
  requireThat([x, y, z].every((c) => Math.abs(c) <= kChunkLimit), 'its key is outside the world');
  return { lod, x, y, z };
}

function readStep(view: DataView, at: number): number {
  const step = view.getFloat32(at, true);
  const isPower = step > 0 && Number.isFinite(step) && Number.isInteger(Math.log2(step));
  requireThat(isPower, `a step of ${step} m`);
  return step;
}

/// Length in bytes of a zstd frame and what it says its content is long. RFC 8878, 3.1.1: blocks carry their lengths.
function frameOf(frame: Uint8Array): { bytes: number; contentBytes: number } {
  const view = new DataView(frame.buffer, frame.byteOffset, frame.byteLength);
  requireThat(frame.length >= 6 && view.getUint32(0, true) === 0xfd2fb528, 'no zstd frame');
  const descriptor = view.getUint8(4);
  const isSingle = (descriptor & 0x20) !== 0;
  requireThat((descriptor & 0x1f) === 0, 'a zstd frame with a dictionary, a checksum or reserved bits');
  const sizeBytes = [isSingle ? 1 : 0, 2, 4, 8][descriptor >> 6] ?? 0;
  let at = isSingle ? 5 : 6;
  requireThat(sizeBytes > 0 && frame.length >= at + sizeBytes, 'a zstd frame that does not say its length');
  let contentBytes = sizeBytes === 2 ? 256 : 0;
  for (let i = 0; i < sizeBytes; i += 1) contentBytes += view.getUint8(at + i) * 2 ** (8 * i);
  at += sizeBytes;
  for (let isLast = false; !isLast; ) {
    requireThat(frame.length >= at + 3, 'a zstd frame that is cut');
    const head = view.getUint8(at) | (view.getUint8(at + 1) << 8) | (view.getUint8(at + 2) << 16);
    isLast = (head & 1) !== 0;
    at += 3 + (((head >> 1) & 3) === 1 ? 1 : head >> 3);
  }
  return { bytes: at, contentBytes };
}

/// The content of one zstd frame that fills `packed` and holds exactly `contentBytes`.
function unpack(packed: Uint8Array, contentBytes: number): Uint8Array {
  const frame = frameOf(packed);
  requireThat(frame.bytes === packed.length, 'something behind its zstd frame');
  requireThat(frame.contentBytes === contentBytes, `${frame.contentBytes} bytes of content instead of ${contentBytes}`);
  const content = decompress(packed, new Uint8Array(contentBytes));
  requireThat(content.length === contentBytes, 'its zstd frame holds less than it says');
  return content;
}

/// 0, 1, 2, 3 .. -> 0, -1, 1, -2 ..
function unzigzag(folded: number): number {
  return (folded >>> 1) ^ -(folded & 1);
}

/// Throws on bytes that are no height tile.
export function decodeHeight(bytes: Uint8Array): HeightTile {
  const { view, lod, cells, seventh: planes } = readHeader(bytes, 'tlsh');
  requireThat(planes <= kPlanesMax, `${planes} planes`);
  const key = keyOf(lod, view.getInt32(8, true), 0, view.getInt32(12, true));
  const stepM = readStep(view, 16);
  const first = view.getInt32(20, true);
  const count = cells + 1;
  const columns = count * count;
  const content = unpack(bytes.subarray(kHeaderBytes), (planes + 2) * columns);

  const heights = new Int32Array(columns);
  const ridges = new Uint8Array(columns);
  const height = (i: number): number => heights[i] as number;
  for (let at = 0; at < columns; at += 1) {
    let left = 0;
    for (let plane = 0; plane < planes; plane += 1) left |= (content[plane * columns + at] as number) << (8 * plane);
    let expected = first;
    if (at >= count && at % count > 0) expected = height(at - 1) + height(at - count) - height(at - count - 1);
    else if (at > 0) expected = height(at < count ? at - 1 : at - count);
    heights[at] = expected + unzigzag(left); // an Int32Array keeps it modulo 2^32
    const before = at === 0 ? 0 : (ridges[at < count ? at - 1 : at - count] as number);
    ridges[at] = before + (content[planes * columns + at] as number);
  }
  return { key, cells, stepM, heights, ridges, materials: content.slice((planes + 1) * columns) };
}

/// Throws on bytes that are no density tile.
export function decodeDensity(bytes: Uint8Array): DensityTile {
  const { view, lod, cells, seventh } = readHeader(bytes, 'tlsd');
  requireThat(seventh === 0, 'byte 7 is not 0');
  const key = keyOf(lod, view.getInt32(8, true), view.getInt32(12, true), view.getInt32(16, true));
  const stepM = readStep(view, 20);
  const count = cells + 1;
  const layer = count * count;
  const samples = layer * count;
  const content = unpack(bytes.subarray(kHeaderBytes), 3 * samples);

  const densities = new Int16Array(samples);
  const p = (i: number): number => densities[i] as number;
  for (let at = 0; at < samples; at += 1) {
    const i = at % count;
    const k = Math.floor(at / count) % count;
    let expected = 0;
    if (at >= 2 * layer) {
      expected = 2 * p(at - layer) - p(at - 2 * layer);
    } else if (at >= layer) {
      let rise = kStepsPerCell;
      if (i > 0) rise = p(at - 1) - p(at - 1 - layer);
      else if (k > 0) rise = p(at - count) - p(at - count - layer);
      expected = p(at - layer) + rise;
    } else if (i > 0 && k > 0) {
      expected = p(at - 1) + p(at - count) - p(at - count - 1);
    } else if (at > 0) {
      expected = p(i > 0 ? at - 1 : at - count);
    }
    expected = Math.max(-kDensityHeld, Math.min(kDensityHeld - 1, expected));
    const left = (content[at] as number) | ((content[samples + at] as number) << 8);
    const density = expected + unzigzag(left);
    requireThat(density >= -kDensityHeld && density < kDensityHeld, 'a density beyond what is held');
    densities[at] = density;
  }
  return { key, cells, stepM, densities, materials: content.slice(2 * samples) };
}
