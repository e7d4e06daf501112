// Messages <-> bytes: `u32 head_bytes | head | payload`, little-endian; the head is a FlatBuffers Envelope of
// protocol/schema/talus.fbs. One message per binary WebSocket frame. Pure.

import { Builder, ByteBuffer } from 'flatbuffers';
import type { ChunkFace, StripKey } from './chunk_face';
import type { ChunkKey, Vec3 } from './chunk_key';
import type { AcceptedView } from './interest_area';
import { kChunkLimit, kLodMax, kServerMessageBytesMax } from './limits';
import { Bye } from './generated/talus/wire/bye';
import { ByeReason } from './generated/talus/wire/bye-reason';
import { Chunk } from './generated/talus/wire/chunk';
import { ChunkKind } from './generated/talus/wire/chunk-kind';
import { Credit } from './generated/talus/wire/credit';
import { Envelope } from './generated/talus/wire/envelope';
import { Failed } from './generated/talus/wire/failed';
import { Held } from './generated/talus/wire/held';
import { HeldKey } from './generated/talus/wire/held-key';
import { Hello } from './generated/talus/wire/hello';
import { Idle } from './generated/talus/wire/idle';
import type { Key } from './generated/talus/wire/key';
import { Leave } from './generated/talus/wire/leave';
import { Message } from './generated/talus/wire/message';
import { Ping } from './generated/talus/wire/ping';
import { Pong } from './generated/talus/wire/pong';
import { Refused } from './generated/talus/wire/refused';
import { RefusedReason } from './generated/talus/wire/refused-reason';
import { Strip } from './generated/talus/wire/strip';
import { StripKey as WireStripKey } from './generated/talus/wire/strip-key';
import { Vec3 as WireVec3 } from './generated/talus/wire/vec3';
import { View } from './generated/talus/wire/view';
import { ViewAccepted } from './generated/talus/wire/view-accepted';
import { Want } from './generated/talus/wire/want';
import { Welcome } from './generated/talus/wire/welcome';

export { ByeReason, ChunkKind, RefusedReason };

export interface HeldChunk {
  key: ChunkKey;
  revision: bigint;
  faces: number; // that its surface reaches: bits of ChunkFace
}

export interface HelloFields {
  versionLow: number;
  versionHigh: number;
  world: string;
  token: string;
  formats: string[];
  creditBytes: number;
  client: string;
}

export interface ViewFields {
  sequence: number;
  position: Vec3;
  direction: Vec3;
  velocity: Vec3;
  nearM: number;
  farM: number;
  lodBias: number;
}

export type ServerMessage =
  | { type: 'welcome'; version: number; session: string; worldHash: string; format: string; manifestJson: string }
  | { type: 'refused'; reason: RefusedReason; message: string; versions: number[] }
  | { type: 'viewAccepted'; sequence: number; view: AcceptedView; chunks: number }
  | { type: 'chunk'; key: ChunkKey; revision: bigint; kind: ChunkKind; faces: number; payload: Uint8Array }
  | { type: 'strip'; strip: StripKey; revision: bigint; payload: Uint8Array }
  | { type: 'failed'; key: ChunkKey; face: ChunkFace | null } // null: the chunk itself
  | { type: 'leave'; keys: ChunkKey[] }
  | { type: 'idle'; viewSequence: number; chunksSent: bigint }
  | { type: 'ping'; nonce: bigint }
  | { type: 'pong'; nonce: bigint }
  | { type: 'bye'; reason: ByeReason; message: string };

/// A server's bytes that are not a message. The connection that carried them is of no more use.
export class MessageError extends Error {}

function frame(type: Message, write: (builder: Builder) => number): Uint8Array {
  const builder = new Builder(256);
  const body = write(builder);
  Envelope.finishEnvelopeBuffer(builder, Envelope.createEnvelope(builder, type, body));
  const head = builder.asUint8Array();
  const bytes = new Uint8Array(4 + head.length);
  new DataView(bytes.buffer).setUint32(0, head.length, true);
  bytes.set(head, 4);
  return bytes;
}

export function encodeHello(hello: HelloFields): Uint8Array {
  return frame(Message.Hello, (builder) => {
    const world = builder.createString(hello.world);
    const token = builder.createString(hello.token);
    const formats = Hello.createFormatsVector(
      builder,
      hello.formats.map((format) => builder.createString(format)),
    );
    const client = builder.createString(hello.client);
    const credit = BigInt(hello.creditBytes);
    return Hello.createHello(builder, hello.versionLow, hello.versionHigh, world, token, formats, credit, client);
  });
}

export function encodeView(view: ViewFields): Uint8Array {
  const struct = (builder: Builder, v: Vec3): number => WireVec3.createVec3(builder, v.x, v.y, v.z);
  return frame(Message.View, (builder) => {
    View.startView(builder);
    View.addSequence(builder, view.sequence);
    View.addPosition(builder, struct(builder, view.position));
    View.addDirection(builder, struct(builder, view.direction));
    View.addVelocity(builder, struct(builder, view.velocity));
    View.addNearM(builder, view.nearM);
    View.addFarM(builder, view.farM);
    View.addLodBias(builder, view.lodBias);
    return View.endView(builder);
  });
}

function stripVector(builder: Builder, strips: StripKey[]): void {
  for (let i = strips.length - 1; i >= 0; --i) {
    const { key, face } = strips[i]!;
    WireStripKey.createStripKey(builder, key.lod, key.x, key.y, key.z, face);
  }
}

/// At most kKeysPerMessageMax chunks and strips together.
export function encodeHeld(chunks: HeldChunk[], strips: StripKey[]): Uint8Array {
  return frame(Message.Held, (builder) => {
    Held.startChunksVector(builder, chunks.length);
    for (let i = chunks.length - 1; i >= 0; --i) {
      const { key, revision } = chunks[i]!;
      HeldKey.createHeldKey(builder, key.lod, key.x, key.y, key.z, revision);
    }
    const chunkVector = builder.endVector();
    const faces = Held.createFacesVector(builder, new Uint8Array(chunks.map((chunk) => chunk.faces)));
    Held.startStripsVector(builder, strips.length);
    stripVector(builder, strips);
    return Held.createHeld(builder, chunkVector, faces, builder.endVector());
  });
}

/// Strips that no view asks for; at most kKeysPerMessageMax. Replaces the last want.
export function encodeWant(strips: StripKey[]): Uint8Array {
  return frame(Message.Want, (builder) => {
    Want.startChunksVector(builder, 0);
    const chunks = builder.endVector();
    Want.startStripsVector(builder, strips.length);
    stripVector(builder, strips);
    return Want.createWant(builder, chunks, builder.endVector());
  });
}

export function encodeCredit(bytes: number): Uint8Array {
  return frame(Message.Credit, (builder) => Credit.createCredit(builder, BigInt(bytes)));
}

export function encodePing(nonce: bigint): Uint8Array {
  return frame(Message.Ping, (builder) => Ping.createPing(builder, nonce));
}

export function encodePong(nonce: bigint): Uint8Array {
  return frame(Message.Pong, (builder) => Pong.createPong(builder, nonce));
}

export function encodeBye(reason: ByeReason, message: string): Uint8Array {
  return frame(Message.Bye, (builder) => Bye.createBye(builder, reason, builder.createString(message)));
}

function plainKey(key: Key | null): ChunkKey {
  if (key === null) throw new MessageError('a key is missing');
  const out = { lod: key.lod(), x: key.x(), y: key.y(), z: key.z() };
  const reach = Math.max(Math.abs(out.x), Math.abs(out.y), Math.abs(out.z));
  if (out.lod < 0 || out.lod > kLodMax || reach > kChunkLimit) throw new MessageError('a key is out of range');
  return out;
}

function decodeViewAccepted(table: ViewAccepted): ServerMessage {
  const position = table.position();
  if (position === null) throw new MessageError('view accepted without a position');
  const view = {
    position: { x: position.x(), y: position.y(), z: position.z() },
    nearM: table.nearM(),
    farM: table.farM(),
    lodBias: table.lodBias(),
  };
  return { type: 'viewAccepted', sequence: table.sequence(), view, chunks: table.chunks() };
}

function decodeChunk(table: Chunk, payload: Uint8Array): ServerMessage {
  const kind = table.kind();
  if (table.payloadBytes() !== payload.length) throw new MessageError('a payload is not as long as its head says');
  if ((kind === ChunkKind.Mesh) !== payload.length > 0) throw new MessageError('a payload does not fit its kind');
  return { type: 'chunk', key: plainKey(table.key()), revision: table.revision(), kind, faces: table.faces(), payload };
}

function decodeStrip(table: Strip, payload: Uint8Array): ServerMessage {
  if (table.payloadBytes() !== payload.length) throw new MessageError('a payload is not as long as its head says');
  const face = table.face();
  if (face > 5) throw new MessageError('a face that no chunk has');
  return { type: 'strip', strip: { key: plainKey(table.key()), face: face as ChunkFace }, revision: table.revision(), payload };
}

function decodeFailed(table: Failed): ServerMessage {
  const face = table.face();
  if (face < -1 || face > 5) throw new MessageError('a face that no chunk has');
  return { type: 'failed', key: plainKey(table.key()), face: face < 0 ? null : (face as ChunkFace) };
}

function decodeRefused(table: Refused): ServerMessage {
  const versions = [...(table.versionsArray() ?? [])];
  return { type: 'refused', reason: table.reason(), message: table.message() ?? '', versions };
}

function decodeWelcome(table: Welcome): ServerMessage {
  return {
    type: 'welcome',
    version: table.version(),
    session: table.session() ?? '',
    worldHash: table.worldHash() ?? '',
    format: table.format() ?? '',
    manifestJson: table.manifestJson() ?? '{}',
  };
}

function decodeBody(envelope: Envelope, payload: Uint8Array): ServerMessage {
  const body = <T>(table: T): T => envelope.message(table) as T;
  switch (envelope.messageType()) {
    case Message.Welcome:
      return decodeWelcome(body(new Welcome()));
    case Message.Refused:
      return decodeRefused(body(new Refused()));
    case Message.ViewAccepted:
      return decodeViewAccepted(body(new ViewAccepted()));
    case Message.Chunk:
      return decodeChunk(body(new Chunk()), payload);
    case Message.Strip:
      return decodeStrip(body(new Strip()), payload);
    case Message.Failed:
      return decodeFailed(body(new Failed()));
    case Message.Leave: {
      const leave = body(new Leave());
      const keys = Array.from({ length: leave.keysLength() }, (_, i) => plainKey(leave.keys(i)));
      return { type: 'leave', keys };
    }
    case Message.Idle: {
      const idle = body(new Idle());
      return { type: 'idle', viewSequence: idle.viewSequence(), chunksSent: idle.chunksSent() };
    }
    case Message.Ping:
      return { type: 'ping', nonce: body(new Ping()).nonce() };
    case Message.Pong:
      return { type: 'pong', nonce: body(new Pong()).nonce() };
    case Message.Bye: {
      const bye = body(new Bye());
      return { type: 'bye', reason: bye.reason(), message: bye.message() ?? '' };
    }
    default:
      throw new MessageError(`a message of type ${envelope.messageType()}, which no server sends`);
  }
}

/// Throws MessageError on anything but a message of a server. The payload is a view into `bytes`.
export function decode(bytes: Uint8Array): ServerMessage {
  if (bytes.length < 4 || bytes.length > kServerMessageBytesMax) throw new MessageError('a message of impossible length');
  const headBytes = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  if (headBytes < 8 || headBytes > bytes.length - 4) throw new MessageError('a head longer than its message');
  try {
    const head = new ByteBuffer(bytes.subarray(4, 4 + headBytes));
    return decodeBody(Envelope.getRootAsEnvelope(head), bytes.subarray(4 + headBytes));
  } catch (error) {
    if (error instanceof MessageError) throw error;
    throw new MessageError(`a malformed head: ${String(error)}`);
  }
}
