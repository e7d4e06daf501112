// Which changes must wait so that what is drawn has no gap, and which strips close it.
//
// Two drawn chunks that meet in a face which the surface reaches differ by at most one LOD, and then the coarser one's
// strip on that face is held. Changes of places are made together; one that would break this is taken back, and so on
// until none does: what is left is the largest set of changes that can be made now. When everything has arrived that is
// all of them, since an interest area is closed; so nothing waits for ever. A face that no surface reaches has no gap
// at whatever LODs. Owner: ChunkStore.

import type { ChunkFace, StripKey } from '../protocol/chunk_face';
import type { ChunkNode, HeldStrip, Swap } from './chunk_node';
import type { DrawTarget } from './chunk_store';

export class Seams<Mesh> {
  /// Strips that are missing and that the server will not send by itself, since not both chunks are wanted.
  stray: StripKey[] = [];
  private shown = new Set<HeldStrip<Mesh>>();

  constructor(
    private readonly nodes: ReadonlyMap<string, ChunkNode<Mesh>>,
    private readonly target: DrawTarget<Mesh>,
  ) {}

  get shownCount(): number {
    return this.shown.size;
  }

  shownStrips(): Iterable<HeldStrip<Mesh>> {
    return this.shown;
  }

  /// Takes back swaps until what is drawn next has no gap.
  holdBack(drawn: ReadonlySet<ChunkNode<Mesh>>, swaps: readonly Swap<Mesh>[]): void {
    const stray = new Map<string, StripKey>();
    for (let again = true; again; ) {
      again = false;
      const check = (node: ChunkNode<Mesh>): void => {
        if (node.next && this.hasGap(node, stray)) again = true;
      };
      for (const node of drawn) check(node);
      for (const swap of swaps) if (swap.on) swap.fresh.forEach(check);
    }
    this.stray = [...stray.values()];
  }

  /// Shows the strips between drawn chunks, and no others.
  show(drawn: ReadonlySet<ChunkNode<Mesh>>): void {
    const now = new Set<HeldStrip<Mesh>>();
    for (const node of drawn) {
      for (const { face, names } of node.outlook()) {
        const coarser = this.nodes.get(names[1] ?? '');
        const strip = coarser?.drawn ? coarser.strips[face] : undefined;
        if (strip?.mesh) now.add(strip);
      }
    }
    for (const strip of this.shown) if (!now.has(strip)) this.hide(strip);
    for (const strip of now) {
      if (!strip.shown && strip.mesh) this.target.show(strip.mesh);
      strip.shown = true;
    }
    this.shown = now;
  }

  /// The strips of a chunk go with it.
  forget(node: ChunkNode<Mesh>): void {
    for (const strip of node.strips) {
      if (!strip) continue;
      if (strip.shown) this.hide(strip);
      this.shown.delete(strip);
      if (strip.mesh) this.target.dispose(strip.mesh);
    }
    node.strips = [];
  }

  private hide(strip: HeldStrip<Mesh>): void {
    strip.shown = false;
    if (strip.mesh) this.target.hide(strip.mesh);
  }

  /// Whether a swap had to be taken back for a gap between `node` and something coarser.
  private hasGap(node: ChunkNode<Mesh>, stray: Map<string, StripKey>): boolean {
    for (const { face, names } of node.outlook()) {
      const steps = names.findIndex((name) => this.nodes.get(name)?.next);
      if (steps < 1) continue; // of the same LOD, or nothing
      const coarser = this.nodes.get(names[steps]!)!;
      if (steps === 1 && coarser.strips[face]?.ready) continue;
      if (steps === 1 && !coarser.strips[face]) this.note(coarser, face, node, stray);
      const swap = [node, coarser].find((each) => !each.drawn && each.swap?.on)?.swap;
      if (!swap) continue; // it was drawn so before: a strip that could not be had
      takeBack(swap);
      return true;
    }
    return false;
  }

  private note(coarser: ChunkNode<Mesh>, face: ChunkFace, finer: ChunkNode<Mesh>, stray: Map<string, StripKey>): void {
    if (!coarser.wanted || !finer.wanted) stray.set(`${coarser.name}/${face}`, { key: coarser.key, face });
  }
}

function takeBack<Mesh>(swap: Swap<Mesh>): void {
  swap.on = false;
  for (const node of swap.old) node.next = true;
  for (const node of swap.fresh) node.next = false;
}
