// One session with a server, for as long as the page lives: hello, views, credit, pings, and after a loss the same
// again with what is already held, so that nothing is sent twice. Owner: the main thread.

import type { ChunkFace, StripKey } from './chunk_face';
import type { ChunkKey, Vec3 } from './chunk_key';
import type { AcceptedView } from './interest_area';
import { pageToken } from './join_token';
import { kKeysPerMessageMax, kVersionHigh, kVersionLow } from './limits';
import {
  ByeReason,
  ChunkKind,
  type HeldChunk,
  RefusedReason,
  type ServerMessage,
  decode,
  encodeBye,
  encodeCredit,
  encodeHeld,
  encodeHello,
  encodePing,
  encodePong,
  encodeView,
  encodeWant,
} from './message';

/// What the server may have on the way to us before we have decoded any of it, bytes.
const kCreditBytes = 4 * 1024 * 1024;
/// Credit goes back in portions: a message per chunk would spend the server's limit of messages per second.
const kCreditPortionBytes = 128 * 1024;
const kCreditEvery_ms = 150;
const kPingEvery_ms = 5000;
/// Nothing heard for this long (pongs included): the connection is dead although nobody said so.
const kSilent_ms = 20_000;
const kBackoffFirst_ms = 500;
const kBackoffMax_ms = 15_000;

export interface ViewRequest {
  position: Vec3;
  direction: Vec3;
  velocity: Vec3;
  nearM: number;
  farM: number;
  lodBias: number;
}

export type ConnectionState =
  | { phase: 'connecting'; attempt: number }
  | { phase: 'open'; session: string }
  | { phase: 'waiting'; attempt: number; retryAt_ms: number; why: string }
  | { phase: 'refused'; reason: RefusedReason; why: string; versions: number[] };

export interface Arrival {
  key: ChunkKey;
  revision: bigint;
  kind: ChunkKind;
  faces: number; // that the surface reaches: bits of ChunkFace
  payload: Uint8Array;
  /// Give this back with `consumed` once the chunk has been decoded.
  bytes: number;
}

export interface StripArrival {
  strip: StripKey;
  revision: bigint;
  payload: Uint8Array; // empty: a strip without triangles
  bytes: number; // as of Arrival
}

export interface ConnectionEvents {
  state(state: ConnectionState): void;
  welcome(worldHash: string, manifest: unknown): void;
  accepted(sequence: number, view: AcceptedView): void;
  arrival(arrival: Arrival): void;
  strip(arrival: StripArrival): void;
  /// The server cannot make this chunk (face null) or this strip of it: it will not come.
  failed(key: ChunkKey, face: ChunkFace | null): void;
  leave(keys: ChunkKey[]): void;
  idle(viewSequence: number): void;
  /// What survives a lost connection; asked for after every welcome.
  held(): { chunks: HeldChunk[]; strips: StripKey[] };
}

export class Connection {
  bytesReceived = 0;
  roundTrip_ms = 0;
  /// That payloads come in, as the server said; empty before it did.
  format = '';
  /// Sequence of the last view that was sent; 0 before the first.
  viewSequence = 0;
  private socket: WebSocket | null = null;
  private welcomed = false;
  private attempt = 0;
  private sessions = 0;
  private lastView: ViewRequest | null = null;
  private creditOwed = 0;
  private heardAt_ms = 0;
  private pingSentAt = new Map<bigint, number>();
  private pingNonce = 0n;
  private retryTimer: ReturnType<typeof setTimeout> | undefined;
  private farewell = '';

  constructor(
    private readonly url: string,
    private readonly world: string,
    private readonly formats: string[], // by preference
    private readonly events: ConnectionEvents,
  ) {
    setInterval(() => this.payCredit(), kCreditEvery_ms);
    setInterval(() => this.ping(), kPingEvery_ms);
    addEventListener('pagehide', () => this.leave());
    addEventListener('online', () => this.retryNow());
  }

  open(): void {
    clearTimeout(this.retryTimer);
    this.attempt += 1;
    this.welcomed = false;
    this.creditOwed = 0;
    this.farewell = '';
    this.sessions += 1;
    const session = this.sessions;
    this.events.state({ phase: 'connecting', attempt: this.attempt });
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.hello();
    socket.onmessage = (event) => {
      if (session === this.sessions) this.receive(event.data as ArrayBuffer);
    };
    socket.onclose = (event) => {
      if (session === this.sessions) this.lost(event.reason || this.farewell);
    };
    this.heardAt_ms = performance.now();
    this.socket = socket;
  }

  /// The latest view wins; after a loss it is sent again by itself.
  sendView(view: ViewRequest): void {
    this.lastView = view;
    if (!this.welcomed) return;
    this.viewSequence += 1;
    this.send(encodeView({ sequence: this.viewSequence, ...view }));
  }

  /// Asks for strips that no view needs; the latest wins, and it ends with the session.
  wantStrips(strips: StripKey[]): void {
    if (this.welcomed) this.send(encodeWant(strips.slice(0, kKeysPerMessageMax)));
  }

  /// `bytes` of an arrival have been decoded: the server may send as many again. Those of an earlier session do not
  /// count, its credit ended with it.
  consumed(bytes: number, session: number): void {
    if (session !== this.sessions) return;
    this.creditOwed += bytes;
    if (this.creditOwed >= kCreditPortionBytes) this.payCredit();
  }

  get session(): number {
    return this.sessions;
  }

  retryNow(): void {
    if (this.socket === null) this.open();
  }

  private leave(): void {
    if (this.welcomed) this.send(encodeBye(ByeReason.Leaving, 'the page was closed'));
    this.sessions += 1;
    this.socket?.close(1000);
  }

  private hello(): void {
    this.send(
      encodeHello({
        versionLow: kVersionLow,
        versionHigh: kVersionHigh,
        world: this.world,
        token: pageToken,
        formats: this.formats,
        creditBytes: kCreditBytes,
        client: 'talus-viewer',
      }),
    );
  }

  private receive(data: ArrayBuffer): void {
    this.heardAt_ms = performance.now();
    this.bytesReceived += data.byteLength;
    let message: ServerMessage;
    try {
      message = decode(new Uint8Array(data));
    } catch (error) {
      this.farewell = `the server sent something unreadable (${error instanceof Error ? error.message : String(error)})`;
      this.socket?.close(4000);
      return;
    }
    this.dispatch(message, data.byteLength);
  }

  private dispatch(message: ServerMessage, bytes: number): void {
    switch (message.type) {
      case 'welcome':
        return this.welcomeArrived(message);
      case 'refused':
        return this.refusedArrived(message);
      case 'viewAccepted':
        return this.events.accepted(message.sequence, message.view);
      case 'chunk':
        return this.events.arrival({ ...message, bytes });
      case 'strip':
        return this.events.strip({ ...message, bytes });
      case 'failed':
        return this.events.failed(message.key, message.face);
      case 'leave':
        return this.events.leave(message.keys);
      case 'idle':
        return this.events.idle(message.viewSequence);
      case 'ping':
        return this.send(encodePong(message.nonce));
      case 'pong':
        return this.pongArrived(message.nonce);
      case 'bye':
        this.farewell = message.message || ByeReason[message.reason] || 'the server said goodbye';
        return;
    }
  }

  private welcomeArrived(message: Extract<ServerMessage, { type: 'welcome' }>): void {
    this.attempt = 0;
    this.welcomed = true;
    this.format = message.format;
    this.events.welcome(message.worldHash, JSON.parse(message.manifestJson));
    const { chunks, strips } = this.events.held();
    for (let i = 0; i < chunks.length; i += kKeysPerMessageMax) {
      this.send(encodeHeld(chunks.slice(i, i + kKeysPerMessageMax), []));
    }
    for (let i = 0; i < strips.length; i += kKeysPerMessageMax) {
      this.send(encodeHeld([], strips.slice(i, i + kKeysPerMessageMax)));
    }
    this.events.state({ phase: 'open', session: message.session });
    if (this.lastView) this.sendView(this.lastView);
  }

  private refusedArrived(message: Extract<ServerMessage, { type: 'refused' }>): void {
    if (message.reason === RefusedReason.Busy) {
      this.farewell = message.message || 'the server is full';
      return;
    }
    // Asking again would get the same answer: stay, and say why.
    this.sessions += 1;
    this.socket?.close(1000);
    const { reason, versions } = message;
    this.events.state({ phase: 'refused', reason, why: message.message, versions });
  }

  private pongArrived(nonce: bigint): void {
    const sentAt = this.pingSentAt.get(nonce);
    this.pingSentAt.delete(nonce);
    if (sentAt !== undefined) this.roundTrip_ms = performance.now() - sentAt;
  }

  private lost(why: string): void {
    this.socket = null;
    this.welcomed = false;
    this.pingSentAt.clear();
    const grown = Math.min(kBackoffMax_ms, kBackoffFirst_ms * 2 ** Math.max(0, this.attempt - 1));
    // Up to a third sooner, so that the viewers of one server do not all return in the same instant.
    const wait_ms = grown * (1 - Math.random() / 3);
    this.retryTimer = setTimeout(() => this.open(), wait_ms);
    const attempt = this.attempt + 1;
    this.events.state({ phase: 'waiting', attempt, retryAt_ms: performance.now() + wait_ms, why });
  }

  private payCredit(): void {
    if (!this.welcomed || this.creditOwed === 0) return;
    this.send(encodeCredit(this.creditOwed));
    this.creditOwed = 0;
  }

  private ping(): void {
    if (this.socket === null) return;
    if (performance.now() - this.heardAt_ms > kSilent_ms) {
      this.farewell = 'the server fell silent';
      const silent = this.socket;
      this.sessions += 1;
      silent.close(4001);
      this.lost(this.farewell);
      return;
    }
    if (!this.welcomed) return;
    this.pingNonce += 1n;
    this.pingSentAt.set(this.pingNonce, performance.now());
    this.send(encodePing(this.pingNonce));
  }

  private send(bytes: Uint8Array): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(bytes as Uint8Array<ArrayBuffer>);
  }
}
