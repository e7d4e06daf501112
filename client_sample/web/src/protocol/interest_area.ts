// Which chunks a view needs, exactly as protocol/interest_area.hpp and SPEC.md say: the same doubles in the same order,
// so that the viewer and the server name the same chunks without talking about it. Pure.

import { type ChunkKey, type Vec3, type WorldShape, edgeOf } from './chunk_key';
import { kChunkLimit, kNearEdgesMin, kViewLodMax } from './limits';

/// A view as the server clamped it.
export interface AcceptedView {
  position: Vec3; // metres, world
  nearM: number;
  farM: number;
  lodBias: number;
}

function gap(at: number, low: number, high: number): number {
  return Math.max(low - at, at - high, 0);
}

class Walk {
  private readonly out: ChunkKey[] = [];
  private readonly radius2: number[] = [];
  private readonly far2: number;

  constructor(
    private readonly view: AcceptedView,
    private readonly shape: WorldShape,
  ) {
    this.far2 = view.farM * view.farM;
    const r0 = Math.max(view.nearM * 2 ** -view.lodBias, kNearEdgesMin * edgeOf(shape, 0));
    for (let lod = 0; lod < kViewLodMax; ++lod) {
      const r = r0 * 2 ** lod;
      this.radius2.push(r * r);
    }
  }

  fromRoots(): ChunkKey[] {
    const { position, farM } = this.view;
    const edge = edgeOf(this.shape, kViewLodMax);
    const chunk = (metres: number): number => Math.floor(metres / edge);
    for (let z = chunk(position.z - farM); z <= chunk(position.z + farM); ++z) {
      for (let x = chunk(position.x - farM); x <= chunk(position.x + farM); ++x) {
        for (let y = chunk(this.shape.heightLowM); y <= chunk(this.shape.heightHighM); ++y) {
          this.visit(kViewLodMax, x, y, z);
        }
      }
    }
    return this.out;
  }

  private visit(lod: number, x: number, y: number, z: number): void {
    const { position } = this.view;
    const edge = edgeOf(this.shape, lod);
    const lowY = y * edge;
    const dx = gap(position.x, x * edge, x * edge + edge);
    const dy = gap(position.y, lowY, lowY + edge);
    const dz = gap(position.z, z * edge, z * edge + edge);
    const d2 = dx * dx + dy * dy + dz * dz;
    if (d2 > this.far2) return;
    if (lowY > this.shape.heightHighM || lowY + edge <= this.shape.heightLowM) return;
    if (lod > 0 && d2 < this.radius2[lod - 1]!) {
      for (let i = 0; i < 8; ++i) {
        this.visit(lod - 1, 2 * x + (i & 1), 2 * y + ((i >> 1) & 1), 2 * z + (i >> 2));
      }
    } else if (Math.max(Math.abs(x), Math.abs(y), Math.abs(z)) <= kChunkLimit) {
      this.out.push({ lod, x, y, z });
    }
  }
}

/// The leaves of the interest area, in no particular order, without duplicates.
export function interestArea(view: AcceptedView, shape: WorldShape): ChunkKey[] {
  return new Walk(view, shape).fromRoots();
}
