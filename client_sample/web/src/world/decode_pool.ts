// Decoding off the main thread: as many workers as there are cores to spare, each with a short queue. Owner: the main
// thread.

import type { DecodeAnswer, DecodeJob } from './decode_worker';
import type { PackedMesh } from './packed_mesh';

const kWorkersMax = 4;

type Outcome = (mesh: PackedMesh | null, fault: string) => void;

export class DecodePool {
  private readonly workers: { worker: Worker; queued: number }[] = [];
  private readonly waiting = new Map<number, Outcome>();
  private nextId = 1;

  constructor(onFault: (why: string) => void) {
    const count = Math.max(1, Math.min(kWorkersMax, (navigator.hardwareConcurrency || 2) - 1));
    for (let i = 0; i < count; ++i) {
      const worker = new Worker(new URL('./decode_worker.ts', import.meta.url), { type: 'module' });
      const slot = { worker, queued: 0 };
      worker.onmessage = (event: MessageEvent<DecodeAnswer>) => {
        slot.queued -= 1;
        this.finish(event.data);
      };
      worker.onerror = (event) => onFault(event.message || 'a decode worker did not start');
      this.workers.push(slot);
    }
  }

  /// `outcome` is called once, later. Jobs of one worker finish in order, jobs of different workers in any.
  decode(payload: Uint8Array, stepM: number, outcome: Outcome): void {
    const id = this.nextId++;
    this.waiting.set(id, outcome);
    const slot = this.workers.reduce((least, each) => (each.queued < least.queued ? each : least));
    slot.queued += 1;
    const own = new Uint8Array(payload); // the frame it came in may hold more than the payload
    const job: DecodeJob = { id, payload: own, stepM };
    slot.worker.postMessage(job, [own.buffer]);
  }

  get queued(): number {
    return this.waiting.size;
  }

  private finish(answer: DecodeAnswer): void {
    const outcome = this.waiting.get(answer.id);
    this.waiting.delete(answer.id);
    if ('mesh' in answer) outcome?.(answer.mesh, '');
    else outcome?.(null, answer.fault);
  }
}
