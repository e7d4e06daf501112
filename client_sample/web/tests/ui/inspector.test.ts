import { expect, test } from 'vitest';
import { groundFacts } from '../../src/protocol/server_info';
import { Inspector, type Look } from '../../src/ui/inspector';

const look = (x: number): Look => ({ from: [x, 0, 0], direction: [0, -1, 0] });

test('asks once a look has come to rest, and only once', () => {
  const asked: Look[] = [];
  const inspector = new Inspector(
    (l) => {
      asked.push(l);
      return Promise.resolve(null);
    },
    () => undefined,
  );
  for (let t = 0; t < 2000; t += 200) inspector.update(look(t), t); // moving
  expect(asked).toEqual([]);
  for (let t = 2000; t < 4000; t += 200) inspector.update(look(7), t);
  expect(asked).toEqual([look(7)]);
});

test('an answer to a look that has passed is not shown', async () => {
  const shown: string[] = [];
  let answer: (facts: { heightM: number; text: string }) => void = () => undefined;
  const inspector = new Inspector(
    () => new Promise((resolve) => (answer = resolve)),
    (facts) => shown.push(facts?.text ?? ''),
  );
  for (const t of [0, 200, 400]) inspector.update(look(1), t);
  inspector.update(look(2), 600);
  answer({ heightM: 1, text: 'late' });
  await Promise.resolve();
  expect(shown).toEqual([]);
});

test('words of a place leave out what the server does not know', () => {
  const point = { x: 0, z: 0, height_m: 1203.7, material: 'stream_bed', layer: 812, layer_set: 3 };
  expect(groundFacts(point).text).toBe('1204 m · stream bed · layer 812 of set 3');
  expect(groundFacts({ ...point, height_m: -35.2, plate: 12, plate_kind: 'oceanic', fault_m: -2340 }).text).toBe(
    'sea 35 m deep · stream bed · layer 812 of set 3 · sea plate 12 · fault 2.3 km away',
  );
  expect(groundFacts({ ...point, district: 'badlands' }).text).toBe('1204 m · stream bed · badlands · layer 812 of set 3');
  expect(groundFacts({ ...point, district: '' }).text).toBe('1204 m · stream bed · layer 812 of set 3');
  expect(() => groundFacts({})).toThrow(/height_m/);
});
