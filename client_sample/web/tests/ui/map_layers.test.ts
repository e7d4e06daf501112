import { expect, test } from 'vitest';
import { mapTileUrl } from '../../src/protocol/server_info';
import { layerTitle, nextLayer } from '../../src/ui/map_layers';

const layers = ['shaded', 'plates', 'districts'];

test('layers follow each other in a ring', () => {
  expect(nextLayer(layers, 'shaded')).toBe('plates');
  expect(nextLayer(layers, 'districts')).toBe('shaded');
  expect(nextLayer(layers, 'gone')).toBe('shaded');
  expect(nextLayer([], 'shaded')).toBe('shaded');
});

test('layers have words for people, those of newer servers their own', () => {
  expect(layerTitle('ridge')).toBe('Ridges and gullies');
  expect(layerTitle('snow_depth')).toBe('Snow depth');
});

test('a tile is asked for by its layer, the relief without a word', () => {
  const base = new URL('http://127.0.0.1:8080/');
  expect(mapTileUrl(base, 'default', 'shaded', 3, -1, 2).href).toBe('http://127.0.0.1:8080/v1/worlds/default/map/3/-1/2.png');
  expect(mapTileUrl(base, 'a b', 'plates', 0, 0, 0).href).toBe('http://127.0.0.1:8080/v1/worlds/a%20b/map/0/0/0.png?layer=plates');
});
