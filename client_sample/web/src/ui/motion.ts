// How the visitor moves: flying, or walking on the ground. World positions are doubles, metres. Pure but for `Ground`.

export interface Body {
  x: number;
  y: number; // of the eyes
  z: number;
  yaw: number; // radians; 0 looks along -z, grows to the left
  pitch: number;
  velocityX: number; // metres per second
  velocityY: number;
  velocityZ: number;
  walking: boolean;
}

export interface Steering {
  right: number; // -1 .. 1
  up: number;
  ahead: number;
  hurried: boolean;
  speedSteps: number;
}

/// The highest ground at (x, z) not above `ceilingM`, and how level it is; null where none is known.
export type Ground = (x: number, z: number, ceilingM: number) => { heightM: number; up: number } | null;

const kFlySpeed = 38; // metres per second at the ground
const kHurry = 5;
const kEase_s = 0.22; // flying comes up to speed and to rest
const kWalkSpeed = 4.2;
const kWalkHurry = 2.4;
const kEyeHeight = 1.75;
const kStepUp = 0.9; // a ledge this high is walked over
/// So far above the ground one still stands on it, and rises smaller than the second are not worth smoothing.
const kFollow = 0.35;
const kSmallStep = 0.01;
const kGravity = 9.81;
const kJumpSpeed = 5.2;
const kSteepest = 0.45; // y component of the normal: about 63 degrees
/// Swimming depth: in deeper water one floats.
const kFloatEyes = 0.35;

export function createBody(x: number, y: number, z: number, yaw: number, pitch: number): Body {
  return { x, y, z, yaw, pitch, velocityX: 0, velocityY: 0, velocityZ: 0, walking: false };
}

export function turn(body: Body, yaw: number, pitch: number): void {
  const limit = Math.PI / 2 - 0.01;
  body.yaw = (body.yaw + yaw) % (2 * Math.PI);
  body.pitch = Math.max(-limit, Math.min(limit, body.pitch + pitch));
}

export function fly(body: Body, steering: Steering, dt_s: number): void {
  // Higher up everything is further away, so speed grows with height above the sea.
  const speed = kFlySpeed * (1 + Math.max(0, body.y) / 700) * 2 ** steering.speedSteps * (steering.hurried ? kHurry : 1);
  const cosPitch = Math.cos(body.pitch);
  const sin = Math.sin(body.yaw);
  const cos = Math.cos(body.yaw);
  const wish = {
    x: -sin * cosPitch * steering.ahead + cos * steering.right,
    y: Math.sin(body.pitch) * steering.ahead + steering.up,
    z: -cos * cosPitch * steering.ahead - sin * steering.right,
  };
  const length = Math.max(1, Math.hypot(wish.x, wish.y, wish.z));
  const share = 1 - Math.exp(-dt_s / kEase_s);
  body.velocityX += ((wish.x / length) * speed - body.velocityX) * share;
  body.velocityY += ((wish.y / length) * speed - body.velocityY) * share;
  body.velocityZ += ((wish.z / length) * speed - body.velocityZ) * share;
  body.x += body.velocityX * dt_s;
  body.y += body.velocityY * dt_s;
  body.z += body.velocityZ * dt_s;
}

/// Keeps a flier out of the ground it can see.
export function stayAbove(body: Body, ground: Ground): void {
  const below = ground(body.x, body.z, body.y + 3);
  if (below && body.y < below.heightM + 1) {
    body.y = below.heightM + 1;
    body.velocityY = Math.max(0, body.velocityY);
  }
}

export function walk(body: Body, steering: Steering, ground: Ground, dt_s: number): void {
  const speed = kWalkSpeed * (steering.hurried ? kWalkHurry : 1);
  const sin = Math.sin(body.yaw);
  const cos = Math.cos(body.yaw);
  const length = Math.max(1, Math.hypot(steering.ahead, steering.right));
  const share = 1 - Math.exp(-dt_s / 0.1);
  body.velocityX += ((speed * (-sin * steering.ahead + cos * steering.right)) / length - body.velocityX) * share;
  body.velocityZ += ((speed * (-cos * steering.ahead - sin * steering.right)) / length - body.velocityZ) * share;
  const feet = body.y - kEyeHeight;
  const x = body.x + body.velocityX * dt_s;
  const z = body.z + body.velocityZ * dt_s;
  const next = ground(x, z, feet + kStepUp);
  const here = ground(body.x, body.z, feet + kStepUp);
  const climbs = next !== null && here !== null && next.heightM > here.heightM + 0.02 && next.up < kSteepest;
  if (next !== null && !climbs) {
    body.x = x;
    body.z = z;
  } else {
    body.velocityX = 0;
    body.velocityZ = 0;
  }
  fall(body, climbs ? here : (next ?? here), dt_s);
}

function fall(body: Body, below: { heightM: number } | null, dt_s: number): void {
  // Ground that has not arrived yet carries: nobody falls through the world while it loads.
  if (below === null) {
    body.velocityY = 0;
    return;
  }
  const stand = Math.max(below.heightM + kEyeHeight, kFloatEyes);
  if (body.velocityY <= 0 && body.y - stand < kFollow) {
    // Downhill the feet keep to the ground; a step up is taken smoothly, not jumped.
    const rise = stand - body.y;
    body.velocityY = 0;
    body.y += rise <= kSmallStep ? rise : Math.max(rise * Math.min(1, dt_s * 14), kSmallStep, rise - kStepUp);
    return;
  }
  body.velocityY -= kGravity * dt_s;
  body.y = Math.max(stand, body.y + body.velocityY * dt_s);
}

export function jump(body: Body, ground: Ground): void {
  if (!body.walking) return;
  const below = ground(body.x, body.z, body.y - kEyeHeight + kStepUp);
  const stand = Math.max((below?.heightM ?? -Infinity) + kEyeHeight, kFloatEyes);
  if (body.y - stand < kFollow) {
    body.y = Math.max(body.y, stand) + kFollow * 1.01; // clear of the band that follows the ground
    body.velocityY = kJumpSpeed;
  }
}
