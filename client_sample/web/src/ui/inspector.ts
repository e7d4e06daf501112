// What lies under the pointer: asked of the server once the look has come to rest. Owner: the main thread.

import type { GroundFacts } from '../protocol/server_info';

const kRest_ms = 260;

export interface Look {
  from: readonly [number, number, number]; // metres
  direction: readonly [number, number, number];
}

/// How a look is told from another: centimetres and a tenth of a milliradian.
function keyOf(look: Look): string {
  return [...look.from.map((v) => v.toFixed(2)), ...look.direction.map((v) => v.toFixed(4))].join();
}

export class Inspector {
  private key = '';
  private since_ms = 0;
  private answeredKey = '';
  private asking = new AbortController();

  constructor(
    private readonly ask: (look: Look, signal: AbortSignal) => Promise<GroundFacts | null>,
    private readonly show: (facts: GroundFacts | null) => void,
  ) {}

  /// Called a few times a second. A look that stays the same is asked about once; any other withdraws the question.
  update(look: Look, now_ms: number): void {
    const key = keyOf(look);
    if (key !== this.key) {
      this.key = key;
      this.since_ms = now_ms;
      this.asking.abort();
      return;
    }
    if (key === this.answeredKey || now_ms - this.since_ms < kRest_ms) return;
    this.answeredKey = key;
    const asking = new AbortController();
    this.asking = asking;
    this.ask(look, asking.signal).then(
      (facts) => {
        if (!asking.signal.aborted) this.show(facts);
      },
      () => undefined, // the connection's own notice tells of a lost server
    );
  }
}
