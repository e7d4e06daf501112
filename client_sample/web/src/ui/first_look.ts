// Which way to look first: at land, the higher the better, and across the light, which models it best. Pure.

const kBearings = 16;
const kDistances_m = [800, 2000, 4000, 7000]; // further out the air closes
const kAgainstLight = 0.35; // share of a view's worth lost when it looks straight into or away from the sun
const kHigh_m = 1200; // land this high is as good as it gets

export interface Look {
  yaw: number; // degrees; 0 looks along -z (north), grows to the left
  places: [number, number][]; // x, z in metres, along that look
}

/// The looks to choose from around (x, z).
export function looksAround(x: number, z: number): Look[] {
  return Array.from({ length: kBearings }, (_, i) => {
    const yaw = (i * 360) / kBearings;
    const turn = (yaw * Math.PI) / 180;
    return { yaw, places: kDistances_m.map((m): [number, number] => [x - Math.sin(turn) * m, z - Math.cos(turn) * m]) };
  });
}

/// The yaw of the look with the most to see. `heights` has one height for each place of each look, in order; the sun
/// stands at `sunAzimuth` degrees clockwise from north.
export function bestYaw(looks: readonly Look[], heights: readonly number[], sunAzimuth: number): number {
  let best = { yaw: 0, worth: -1 };
  looks.forEach((look, i) => {
    const seen = heights.slice(i * kDistances_m.length, (i + 1) * kDistances_m.length);
    const land = seen.reduce((sum, height) => sum + (height > 0 ? 0.4 + Math.min(height, kHigh_m) / kHigh_m : 0), 0);
    const toSun = Math.abs(Math.cos(((-look.yaw - sunAzimuth) * Math.PI) / 180));
    const worth = land * (1 - kAgainstLight * toSun);
    if (worth > best.worth) best = { yaw: look.yaw, worth };
  });
  return best.yaw;
}
