// The world as it comes: asks for views, decodes what arrives, keeps what is held and says when a view is complete.
// Owner: the main thread.

import type { ChunkFace, StripKey } from '../protocol/chunk_face';
import { type ChunkKey, type Vec3, type WorldShape, edgeOf, nameOfKey } from '../protocol/chunk_key';
import { Connection, type Arrival, type ConnectionState, type StripArrival, type ViewRequest } from '../protocol/connection';
import { interestArea } from '../protocol/interest_area';
import { kViewLodMax } from '../protocol/limits';
import { ChunkKind, type HeldChunk } from '../protocol/message';
import type { WorldManifest } from '../protocol/server_info';
import { ChunkStore, type DrawTarget } from './chunk_store';
import { ClosedSurface, type DrawnSurface } from './closed_surface';
import { DecodePool } from './decode_pool';
import { type PackedMesh, kStepsPerCell } from './packed_mesh';
import { type PlacedSurface, type SurfacePoint, surfaceAlong, surfaceBelow } from './surface_index';

/// While moving, a new view this often.
const kViewEvery_ms = 140;
/// Less than this is not worth a message, metres and (for the direction) 1 - cosine.
const kViewMoved_m = 1.5;
const kViewTurned = 0.02;
/// Asking for stray strips, at most this often.
const kStrayEvery_ms = 100;

export interface StreamEvents<Mesh> extends DrawTarget<Mesh> {
  create(key: ChunkKey, shape: WorldShape, packed: PackedMesh): Mesh;
  createStrip(strip: StripKey, shape: WorldShape, packed: PackedMesh): Mesh;
  state(state: ConnectionState): void;
  fault(why: string): void;
}

export class WorldStream<Mesh extends PlacedSurface & DrawnSurface> {
  readonly store: ChunkStore<Mesh>;
  readonly connection: Connection;
  lastLatency_ms = 0;
  /// Where the interest area that is wanted now was reckoned from; null before the first.
  areaFrom: Vec3 | null = null;
  faults = 0;
  private readonly pool: DecodePool;
  private readonly shape: WorldShape;
  private worldHash = '';
  private lastSent: ViewRequest | null = null;
  private lastSent_ms = -Infinity;
  private idleFor = 0; // sequence of the view that the server has sent everything of
  private newSession = false;
  private strayAsked = '';
  private strayAsked_ms = -Infinity;

  constructor(
    url: string,
    manifest: WorldManifest,
    formats: string[],
    private readonly events: StreamEvents<Mesh>,
  ) {
    this.shape = manifest.shape;
    this.store = new ChunkStore<Mesh>(events);
    this.pool = new DecodePool((why) => this.fault(why));
    this.connection = new Connection(url, manifest.name, formats, {
      state: (state) => events.state(state),
      welcome: (worldHash) => this.welcome(worldHash),
      accepted: (sequence, view) => this.accepted(sequence, view),
      arrival: (arrival) => this.arrival(arrival),
      strip: (arrival) => this.stripArrival(arrival),
      failed: (key, face) => this.failed(key, face),
      leave: (keys) => this.store.leave(keys),
      idle: (sequence) => {
        this.idleFor = sequence;
      },
      held: () => ({ chunks: this.heldChunks(), strips: this.store.heldStrips() }),
    });
    this.connection.open();
  }

  /// Once a frame: tells the server where the viewer is if that has changed enough, and swaps what is ready.
  update(view: ViewRequest, now_ms: number): void {
    if (now_ms - this.lastSent_ms >= kViewEvery_ms && this.hasMoved(view)) {
      this.lastSent = view;
      this.lastSent_ms = now_ms;
      this.connection.sendView(view);
    }
    this.store.resolve();
    this.askForStray(now_ms);
  }

  /// The viewer has jumped: nothing is complete until the server has heard of it.
  jumped(): void {
    this.lastSent = null;
    this.lastSent_ms = -Infinity;
    this.idleFor = 0;
  }

  /// Everything that the latest view wants has arrived and is drawn.
  get complete(): boolean {
    return this.idleFor !== 0 && this.idleFor === this.connection.viewSequence && this.store.complete;
  }

  /// The highest drawn ground at (x, z) not above `ceilingM`, the finest first.
  groundBelow(x: number, z: number, ceilingM: number): SurfacePoint | null {
    let best: SurfacePoint | null = null;
    for (let lod = 0; lod <= kViewLodMax; ++lod) {
      const edge = edgeOf(this.shape, lod);
      const top = Math.floor(Math.min(ceilingM, this.shape.heightHighM) / edge);
      const floor = Math.floor(Math.max(this.shape.heightLowM, best?.heightM ?? -Infinity) / edge);
      for (let y = top; y >= floor; --y) {
        const node = this.store.find({ lod, x: Math.floor(x / edge), y, z: Math.floor(z / edge) });
        const mesh = node?.drawn ? node.held?.mesh : null;
        const found = mesh ? surfaceBelow(mesh, x, z, ceilingM) : null;
        if (found === null) continue;
        if (best === null || found.heightM > best.heightM) best = found;
        break;
      }
    }
    return best;
  }

  /// Distance along a ray to what is drawn; null for nothing. For tests and for pointing, not for every frame.
  pick(from: Vec3, towards: Vec3): { distanceM: number; name: string } | null {
    let best: { distanceM: number; name: string } | null = null;
    for (const node of this.store.drawn()) {
      const mesh = node.held?.mesh;
      if (!mesh) continue;
      const distanceM = surfaceAlong(mesh, [from.x, from.y, from.z], [towards.x, towards.y, towards.z]);
      if (distanceM < (best?.distanceM ?? Infinity)) best = { distanceM, name: node.name };
    }
    return best;
  }

  /// Whether the drawn chunks and strips, as they were given to the GPU, are one closed surface: ClosedSurface.
  openEdges(): { edges: number; open: [number, number, number][] } {
    const closed = new ClosedSurface(this.shape.cells);
    for (const node of this.store.drawn()) closed.addPlace(node.key);
    for (const mesh of this.store.shown()) closed.addSurface(mesh);
    return closed.result(this.shape.voxelM);
  }

  /// While places change one after the other, some meet for a moment that no interest area has side by side.
  private askForStray(now_ms: number): void {
    const stray = this.store.strayStrips;
    const names = stray.map(({ key, face }) => `${key.lod}/${key.x}/${key.y}/${key.z}/${face}`).join(' ');
    if (names === this.strayAsked || now_ms - this.strayAsked_ms < kStrayEvery_ms) return;
    this.strayAsked = names;
    this.strayAsked_ms = now_ms;
    this.connection.wantStrips([...stray]);
  }

  private hasMoved(view: ViewRequest): boolean {
    const last = this.lastSent;
    if (last === null) return true;
    const moved = Math.hypot(
      view.position.x - last.position.x,
      view.position.y - last.position.y,
      view.position.z - last.position.z,
    );
    const a = view.direction;
    const b = last.direction;
    const turned = 1 - (a.x * b.x + a.y * b.y + a.z * b.z);
    return moved > kViewMoved_m || turned > kViewTurned || view.farM !== last.farM || view.nearM !== last.nearM;
  }

  private welcome(worldHash: string): void {
    // A server with another world under the same name: nothing of what is held belongs to it.
    if (this.worldHash !== '' && this.worldHash !== worldHash) this.store.clear();
    this.worldHash = worldHash;
    this.newSession = true;
    this.idleFor = 0;
    this.strayAsked = '';
  }

  private heldChunks(): HeldChunk[] {
    return [...this.store.held()].map((node) => ({ key: node.key, revision: node.held!.revision, faces: node.held!.faces }));
  }

  private accepted(sequence: number, view: Parameters<typeof interestArea>[0]): void {
    if (sequence > this.connection.viewSequence) return;
    this.store.want(interestArea(view, this.shape), performance.now());
    this.areaFrom = view.position;
    if (this.newSession) this.store.leaveUnwanted();
    this.newSession = false;
  }

  private arrival(arrival: Arrival): void {
    const { key, revision, kind, faces, payload, bytes } = arrival;
    const session = this.connection.session;
    const node = this.store.arrived(key, revision, faces);
    if (kind !== ChunkKind.Mesh) {
      this.store.ready(node, revision, null);
      this.connection.consumed(bytes, session);
      return;
    }
    this.pool.decode(payload, edgeOf(this.shape, key.lod) / (this.shape.cells * kStepsPerCell), (packed, why) => {
      this.connection.consumed(bytes, session);
      if (packed === null) {
        this.fault(`chunk ${node.name} cannot be decoded: ${why}`);
        this.store.failed(node, revision);
        return;
      }
      this.store.ready(node, revision, this.events.create(key, this.shape, packed));
      if (node.wantedAt_ms > 0) this.lastLatency_ms = performance.now() - node.wantedAt_ms;
    });
  }

  private stripArrival({ strip, payload, bytes }: StripArrival): void {
    const session = this.connection.session;
    const wanted = this.store.stripArrived(strip);
    if (wanted === null || wanted.ready || payload.length === 0) {
      if (wanted !== null) this.store.stripReady(strip, null);
      this.connection.consumed(bytes, session);
      return;
    }
    // On the lattice of the finer chunks that it closes to.
    const stepM = edgeOf(this.shape, strip.key.lod - 1) / (this.shape.cells * kStepsPerCell);
    this.pool.decode(payload, stepM, (packed, why) => {
      this.connection.consumed(bytes, session);
      if (packed === null) this.fault(`a strip cannot be decoded: ${why}`);
      this.store.stripReady(strip, packed && this.events.createStrip(strip, this.shape, packed));
    });
  }

  /// A chunk that does not come leaves its place as it is drawn; a strip that does not come holds nothing up.
  private failed(key: ChunkKey, face: ChunkFace | null): void {
    this.fault(`the server cannot make ${face === null ? 'chunk' : 'a strip of'} ${nameOfKey(key)}`);
    if (face === null || this.store.stripArrived({ key, face }) === null) return;
    this.store.stripReady({ key, face }, null);
  }

  private fault(why: string): void {
    this.faults += 1;
    this.events.fault(why);
  }
}
