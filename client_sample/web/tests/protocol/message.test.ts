import { Builder, ByteBuffer } from 'flatbuffers';
import { describe, expect, test } from 'vitest';
import { Chunk } from '../../src/protocol/generated/talus/wire/chunk';
import { Envelope } from '../../src/protocol/generated/talus/wire/envelope';
import { Failed } from '../../src/protocol/generated/talus/wire/failed';
import { Held } from '../../src/protocol/generated/talus/wire/held';
import { Hello } from '../../src/protocol/generated/talus/wire/hello';
import { Key } from '../../src/protocol/generated/talus/wire/key';
import { Message } from '../../src/protocol/generated/talus/wire/message';
import { View } from '../../src/protocol/generated/talus/wire/view';
import { ChunkKind, MessageError, decode, encodeHeld, encodeHello, encodePing, encodeView } from '../../src/protocol/message';
import { specBytes } from './spec';

function open(bytes: Uint8Array): Envelope {
  const headBytes = new DataView(bytes.buffer).getUint32(0, true);
  expect(bytes.length).toBe(4 + headBytes);
  return Envelope.getRootAsEnvelope(new ByteBuffer(bytes.subarray(4)));
}

function chunkMessage(lod: number, x: number, kind: ChunkKind, claimed: number, payload: Uint8Array): Uint8Array {
  const builder = new Builder(128);
  Chunk.startChunk(builder);
  Chunk.addKey(builder, Key.createKey(builder, lod, x, -2, 3));
  Chunk.addRevision(builder, 7n);
  Chunk.addKind(builder, kind);
  Chunk.addPayloadBytes(builder, claimed);
  const chunk = Chunk.endChunk(builder);
  Envelope.finishEnvelopeBuffer(builder, Envelope.createEnvelope(builder, Message.Chunk, chunk));
  const head = builder.asUint8Array();
  const bytes = new Uint8Array(4 + head.length + payload.length);
  new DataView(bytes.buffer).setUint32(0, head.length, true);
  bytes.set(head, 4);
  bytes.set(payload, 4 + head.length);
  return bytes;
}

function failedMessage(face: number): Uint8Array {
  const builder = new Builder(128);
  Failed.startFailed(builder);
  Failed.addKey(builder, Key.createKey(builder, 1, 2, -3, 4));
  Failed.addFace(builder, face);
  Envelope.finishEnvelopeBuffer(builder, Envelope.createEnvelope(builder, Message.Failed, Failed.endFailed(builder)));
  const head = builder.asUint8Array();
  const bytes = new Uint8Array(4 + head.length);
  new DataView(bytes.buffer).setUint32(0, head.length, true);
  bytes.set(head, 4);
  return bytes;
}

describe('what the viewer says', () => {
  test('hello carries versions, world, formats and credit', () => {
    const fields = { versionLow: 1, versionHigh: 2, world: 'alps', token: '', formats: ['drc'], creditBytes: 4096, client: 'me' };
    const envelope = open(encodeHello(fields));
    expect(envelope.messageType()).toBe(Message.Hello);
    const hello = envelope.message(new Hello()) as Hello;
    expect([hello.versionLow(), hello.versionHigh(), hello.world(), hello.formats(0), hello.creditBytes()]).toEqual([1, 2, 'alps', 'drc', 4096n]);
  });

  test('a view keeps its doubles exactly, 10^9 m out', () => {
    const position = { x: 1e9 + 0.125, y: -3.5, z: -999999999.0625 };
    const direction = { x: 0, y: 0, z: -1 };
    const bytes = encodeView({ sequence: 9, position, direction, velocity: direction, nearM: 128, farM: 12_000, lodBias: 0.5 });
    const view = open(bytes).message(new View()) as View;
    const at = view.position()!;
    expect({ x: at.x(), y: at.y(), z: at.z() }).toEqual(position);
    expect([view.sequence(), view.nearM(), view.farM(), view.lodBias()]).toEqual([9, 128, 12_000, 0.5]);
  });

  test('held keys stay in order', () => {
    const chunks = [0, 1, 2].map((x) => ({ key: { lod: x, x: -x, y: 2 * x, z: 3 * x }, revision: BigInt(x), faces: 9 * x }));
    const held = open(encodeHeld(chunks, [])).message(new Held()) as Held;
    const back = [0, 1, 2].map((i) => {
      const key = held.chunks(i)!.key()!;
      return { key: { lod: key.lod(), x: key.x(), y: key.y(), z: key.z() }, revision: held.chunks(i)!.revision() };
    });
    expect(back).toEqual(chunks.map(({ key, revision }) => ({ key: { ...key, x: key.x + 0 }, revision })));
  });
});

describe('what the server says', () => {
  const payload = new Uint8Array([1, 2, 3, 4, 5]);

  test('a chunk comes with its payload', () => {
    const message = decode(chunkMessage(3, 5, ChunkKind.Mesh, 5, payload));
    expect(message).toEqual({ type: 'chunk', key: { lod: 3, x: 5, y: -2, z: 3 }, revision: 7n, kind: ChunkKind.Mesh, faces: 0, payload });
  });

  test.each([
    ['a payload shorter than claimed', chunkMessage(3, 5, ChunkKind.Mesh, 6, payload)],
    ['air with a payload', chunkMessage(3, 5, ChunkKind.Air, 5, payload)],
    ['a mesh without one', chunkMessage(3, 5, ChunkKind.Mesh, 0, new Uint8Array(0))],
    ['a LOD there is not', chunkMessage(13, 5, ChunkKind.Mesh, 5, payload)],
    ['a coordinate beyond the limit', chunkMessage(3, 2 ** 30, ChunkKind.Mesh, 5, payload)],
    ['a message that only clients send', encodeHello({ versionLow: 1, versionHigh: 1, world: 'w', token: '', formats: [], creditBytes: 0, client: '' })],
    ['a head longer than its message', new Uint8Array([255, 0, 0, 0, 1, 2, 3, 4])],
    ['nothing', new Uint8Array(0)],
  ])('%s is a MessageError', (_, bytes) => expect(() => decode(bytes)).toThrow(MessageError));

  test('every strict prefix of a message is an error or a message, never anything else', () => {
    const whole = chunkMessage(3, 5, ChunkKind.Mesh, 5, payload);
    for (let length = 0; length < whole.length; ++length) {
      expect(() => decode(whole.slice(0, length)), `prefix of ${length}`).toThrow(MessageError);
    }
  });

  test('a chunk and a strip are what the specification shows', () => {
    const key = { lod: 2, x: -3, y: 4, z: -5 };
    const shown = new Uint8Array([0xaa, 0xbb, 0xcc]);
    expect(decode(specBytes('chunk'))).toEqual({ type: 'chunk', key, revision: 6n, kind: ChunkKind.Mesh, faces: 0, payload: shown });
    expect(decode(specBytes('strip'))).toEqual({ type: 'strip', strip: { key, face: 3 }, revision: 6n, payload: shown });
  });

  test('what cannot be made is named, as a chunk or as one of its strips', () => {
    const key = { lod: 1, x: 2, y: -3, z: 4 };
    expect(decode(failedMessage(-1))).toEqual({ type: 'failed', key, face: null });
    expect(decode(failedMessage(4))).toEqual({ type: 'failed', key, face: 4 });
    expect(() => decode(failedMessage(6))).toThrow(MessageError);
    expect(() => decode(failedMessage(-2))).toThrow(MessageError);
  });

  test('a ping is read back', () => expect(decode(encodePing(77n))).toEqual({ type: 'ping', nonce: 77n }));
});
