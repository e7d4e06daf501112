// The switch of the map's layers: what the server can show instead of the shaded relief, in words. Owner: the main thread.

const kWords = new Map([
  ['shaded', 'Relief'],
  ['height', 'Height'],
  ['slope', 'Slope'],
  ['materials', 'Ground and rock'],
  ['layers', 'Rock layers'],
  ['ridge', 'Ridges and gullies'],
  ['hilliness', 'Hilliness'],
  ['plates', 'Plates'],
  ['faults', 'Faults'],
  ['districts', 'Districts'],
]);

/// What people read for a layer; one that is newer than this page by its own word.
export function layerTitle(layer: string): string {
  return kWords.get(layer) ?? layer.charAt(0).toUpperCase() + layer.slice(1).replaceAll('_', ' ');
}

/// The layer after `layer`, the first after the last; `layer` itself where there is no other.
export function nextLayer(layers: readonly string[], layer: string): string {
  return layers[(layers.indexOf(layer) + 1) % layers.length] ?? layer;
}

export class MapLayers {
  constructor(
    private readonly box: HTMLSelectElement,
    private readonly layers: readonly string[],
    private readonly chosen: (layer: string) => void,
  ) {
    box.replaceChildren(...layers.map((layer) => new Option(layerTitle(layer), layer)));
    box.hidden = layers.length < 2; // of a server that draws only one
    box.addEventListener('change', () => chosen(box.value));
  }

  next(): void {
    if (this.box.hidden) return;
    this.box.value = nextLayer(this.layers, this.box.value);
    this.chosen(this.box.value);
  }
}
