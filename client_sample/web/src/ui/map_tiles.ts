// Tiles of the overview map: asked for in order of need, a few at a time, kept while they are of use.
// Owner: the main thread.

const kAtOnce = 6;
const kKept = 256; // of 256 KiB each when decoded
const kRetry_ms = 1500;

export type TileSource = (layer: string, zoom: number, x: number, y: number, signal: AbortSignal) => Promise<ImageBitmap>;

export class MapTiles {
  layer = 'shaded'; // what the map shows; tiles of other layers stay as long as there is room
  private readonly kept = new Map<string, ImageBitmap>(); // the longest unused first
  private readonly asked = new Map<string, AbortController>();
  private readonly resting = new Set<string>(); // failed a moment ago

  constructor(
    private readonly source: TileSource,
    private readonly changed: () => void,
  ) {}

  private keyOf(zoom: number, x: number, y: number): string {
    return `${this.layer}/${zoom}/${x}/${y}`;
  }

  /// The tile of this layer if it is here.
  find(zoom: number, x: number, y: number): ImageBitmap | null {
    const key = this.keyOf(zoom, x, y);
    const found = this.kept.get(key);
    if (found === undefined) return null;
    this.kept.delete(key);
    this.kept.set(key, found);
    return found;
  }

  /// What is wanted now, most urgent first; replaces what was wanted before. The number that is not here yet.
  want(zoom: number, tiles: readonly { x: number; y: number }[]): number {
    const missing = tiles.filter((t) => !this.kept.has(this.keyOf(zoom, t.x, t.y)));
    const keys = new Set(missing.map((t) => this.keyOf(zoom, t.x, t.y)));
    for (const [key, abort] of this.asked) {
      if (keys.has(key)) continue;
      this.asked.delete(key);
      abort.abort();
    }
    for (const { x, y } of missing) {
      if (this.asked.size >= kAtOnce) break;
      const key = this.keyOf(zoom, x, y);
      if (!this.asked.has(key) && !this.resting.has(key)) void this.load(key, zoom, x, y);
    }
    return missing.length;
  }

  private async load(key: string, zoom: number, x: number, y: number): Promise<void> {
    const abort = new AbortController();
    this.asked.set(key, abort);
    try {
      const image = await this.source(this.layer, zoom, x, y, abort.signal);
      this.kept.set(key, image);
      this.evict();
    } catch {
      if (!abort.signal.aborted) {
        this.resting.add(key);
        setTimeout(() => {
          this.resting.delete(key);
          this.changed();
        }, kRetry_ms);
      }
    }
    if (this.asked.get(key) === abort) this.asked.delete(key);
    this.changed();
  }

  private evict(): void {
    for (const [key, image] of this.kept) {
      if (this.kept.size <= kKept) return;
      this.kept.delete(key);
      image.close();
    }
  }
}
