// A place and a look as a URL: ?at=x,y,z&yaw=&pitch=&far=&hud=0 and a few more. Pure.

export interface Place {
  at: [number, number, number] | null; // metres, world
  yaw: number; // degrees; 0 looks along -z (north), grows to the left
  pitch: number; // degrees, positive looks up
  farM: number;
  nearM: number; // LOD 0 reaches this far
  hud: boolean;
  world: string | null;
  formats: string[]; // that chunks may come in, by preference
  sunAzimuth: number; // degrees clockwise from north
  sunHeight: number;
  shadows: boolean;
  samples: number; // of multisampling
  pixelRatio: number | null; // null: the screen's own, lowered when frames take long
}

const kFarMax = 32_768;

/// A number of a query, `absent` if it is missing or not a number, and no further out than the limits.
function number(query: URLSearchParams, name: string, absent: number, low: number, high: number): number {
  const text = query.get(name);
  const value = text === null || text.trim() === '' ? NaN : Number(text);
  return Number.isFinite(value) ? Math.max(low, Math.min(high, value)) : absent;
}

function triple(text: string | null): [number, number, number] | null {
  const parts = (text ?? '').split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
  return parts.length === 3 && parts.every(Number.isFinite) ? (parts as [number, number, number]) : null;
}

export function placeFromQuery(text: string): Place {
  const query = new URLSearchParams(text);
  return {
    at: triple(query.get('at')),
    yaw: number(query, 'yaw', NaN, -360, 360),
    pitch: number(query, 'pitch', NaN, -89, 89),
    farM: number(query, 'far', 30_000, 500, kFarMax),
    nearM: number(query, 'near', 128, 112, 512),
    hud: query.get('hud') !== '0',
    world: query.get('world'),
    formats: query.get('format') === 'mesh' ? ['mesh', 'drc'] : ['drc'],
    sunAzimuth: number(query, 'azimuth', 118, -360, 360),
    sunHeight: number(query, 'sun', 30, 6, 85),
    shadows: query.get('shadows') !== '0',
    samples: Math.round(number(query, 'samples', 4, 0, 8)),
    pixelRatio: query.has('ratio') ? number(query, 'ratio', 1, 0.25, 3) : null,
  };
}

/// The query that leads back here; everything in `before` that is not a place is kept.
export function queryOfPlace(before: string, at: readonly [number, number, number], yaw: number, pitch: number): string {
  const query = new URLSearchParams(before);
  query.set('at', at.map((metres) => metres.toFixed(1)).join(','));
  query.set('yaw', yaw.toFixed(1));
  query.set('pitch', pitch.toFixed(1));
  return `?${query.toString().replaceAll('%2C', ',')}`;
}
