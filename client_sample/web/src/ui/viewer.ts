// The page at work: one loop that reads the input, moves the visitor, feeds the stream, draws, and reports.

import type { ConnectionState } from '../protocol/connection';
import { RefusedReason } from '../protocol/message';
import { fetchGround, fetchHit, fetchMapTile, type WorldManifest, mapTileUrl } from '../protocol/server_info';
import { ChunkMesh } from '../render/terrain_layer';
import type { ViewRenderer } from '../render/view_renderer';
import { WorldStream } from '../world/world_stream';
import { Hud } from './hud';
import { Input } from './input';
import { Inspector } from './inspector';
import { type Body, createBody, fly, jump, stayAbove, turn, walk } from './motion';
import { OverviewMap } from './overview_map';
import { type Place, queryOfPlace } from './place';

const kFrameMax_s = 0.1; // a longer pause is not caught up with
const kHudEvery_ms = 200;
const kSlowFrame_ms = 26; // lower the resolution
const kFastFrame_ms = 12; // and raise it again
const kRatioLow = 0.6;
const kTravelHeight = 140; // metres above the ground or sea one travels to
const kTravelPitch = -0.14; // radians

/// A straight flight at constant speed, for tests and films.
interface Flight {
  from: [number, number, number];
  to: [number, number, number];
  start_ms: number;
  duration_ms: number;
  done: () => void;
}

export class Viewer {
  readonly stream: WorldStream<ChunkMesh>;
  readonly body: Body;
  connection: ConnectionState = { phase: 'connecting', attempt: 1 };
  frame_ms = 16;
  readonly faults: string[] = [];
  readonly map: OverviewMap | null;
  private readonly input: Input;
  private readonly inspector: Inspector;
  private pixelRatio: number;
  private frames = 0;
  private lastFrame_ms = performance.now();
  private lastHud_ms = 0;
  private flight: Flight | null = null;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly renderer: ViewRenderer,
    private readonly hud: Hud,
    private readonly place: Place,
    manifest: WorldManifest,
    base: URL,
    streamUrl: string,
    at: readonly [number, number, number],
  ) {
    const radians = (degrees: number): number => (degrees * Math.PI) / 180;
    this.body = createBody(at[0], at[1], at[2], radians(place.yaw), radians(place.pitch));
    this.pixelRatio = place.pixelRatio ?? Math.min(devicePixelRatio, 2);
    renderer.setFar(place.farM);
    if (!place.shadows) renderer.turnShadowsOff();
    renderer.terrain.setPalette(manifest.colours);
    this.input = new Input(canvas, document.getElementById('stick')!, {
      toggleWalk: () => this.toggleWalk(),
      toggleHelp: () => hud.toggleHelp(),
      toggleHud: () => hud.toggleFigures(),
      share: () => this.share(),
      toggleWire: () => this.toggleOverlay(true, false),
      toggleSeams: () => this.toggleOverlay(false, true),
      toggleMap: () => this.map?.toggle(),
      jump: () => jump(this.body, this.ground),
    });
    this.stream = new WorldStream<ChunkMesh>(streamUrl, manifest, place.formats, {
      create: (key, shape, packed) => new ChunkMesh(key, shape, packed, false),
      createStrip: (strip, shape, packed) => new ChunkMesh(strip.key, shape, packed, true),
      show: (chunk) => renderer.terrain.show(chunk),
      hide: (chunk) => renderer.terrain.hide(chunk),
      dispose: (chunk) => renderer.terrain.dispose(chunk),
      state: (state) => this.connectionChanged(state),
      fault: (why) => this.faults.push(why),
    });
    this.inspector = new Inspector(
      (look, signal) => fetchHit(base, manifest.name, look.from, look.direction, signal),
      (facts) => hud.showUnder(facts?.text ?? ''),
    );
    this.map = this.createMap(manifest, base);
    addEventListener('resize', () => this.resize());
    this.resize();
  }

  private createMap(manifest: WorldManifest, base: URL): OverviewMap | null {
    if (manifest.map === null) return null;
    const { name } = manifest;
    const ask = (x: number, z: number, signal: AbortSignal) => fetchGround(base, name, x, z, signal);
    return new OverviewMap(manifest.map, (layer, zoom, x, y, signal) => fetchMapTile(mapTileUrl(base, name, layer, zoom, x, y), signal), {
      visitor: () => this.body,
      ask,
      opened: () => this.input.release(),
      travel: (x, z) => {
        void ask(x, z, new AbortController().signal).then((facts) => {
          if (facts === null) {
            this.hud.say('The server does not say how high the ground is there');
            return;
          }
          const away = Math.hypot(x - this.body.x, z - this.body.z);
          this.goTo([x, Math.max(facts.heightM, 0) + kTravelHeight, z], this.body.yaw, kTravelPitch);
          this.hud.say(`Travelled ${away < 1000 ? `${Math.round(away)} m` : `${(away / 1000).toFixed(1)} km`}`);
        });
      },
    });
  }

  start(): void {
    const loop = (now_ms: number): void => {
      requestAnimationFrame(loop);
      this.frame(now_ms);
    };
    requestAnimationFrame(loop);
  }

  flyAlong(to: readonly [number, number, number], seconds: number): Promise<void> {
    this.body.walking = false;
    return new Promise((done) => {
      const from: [number, number, number] = [this.body.x, this.body.y, this.body.z];
      this.flight = { from, to: [...to], start_ms: performance.now(), duration_ms: seconds * 1000, done };
    });
  }

  /// Metres and radians, at once.
  goTo(at: readonly [number, number, number], yaw: number, pitch: number): void {
    [this.body.x, this.body.y, this.body.z] = at;
    this.body.yaw = yaw;
    this.body.pitch = pitch;
    this.body.velocityX = this.body.velocityY = this.body.velocityZ = 0;
    this.flight = null;
    this.stream.jumped();
  }

  direction(): { x: number; y: number; z: number } {
    const { yaw, pitch } = this.body;
    return { x: -Math.sin(yaw) * Math.cos(pitch), y: Math.sin(pitch), z: -Math.cos(yaw) * Math.cos(pitch) };
  }

  readonly ground = (x: number, z: number, ceilingM: number) => this.stream.groundBelow(x, z, ceilingM);

  toggleWalk(): void {
    this.body.walking = !this.body.walking;
    this.body.velocityX = this.body.velocityY = this.body.velocityZ = 0;
    this.hud.say(this.body.walking ? 'Walking' : 'Flying');
  }

  private toggleOverlay(wire: boolean, seams: boolean): void {
    const { terrain } = this.renderer;
    const before = terrain.overlay;
    terrain.setOverlay(before.wire !== wire, before.seams !== seams);
    if (seams) this.hud.say(before.seams ? 'Seam strips as terrain' : 'Seam strips in colour');
    else this.hud.say(before.wire ? 'Surfaces' : 'Triangles');
  }

  private frame(now_ms: number): void {
    const elapsed_ms = now_ms - this.lastFrame_ms;
    this.lastFrame_ms = now_ms;
    this.frames += 1;
    this.frame_ms += (elapsed_ms - this.frame_ms) * 0.08;
    this.move(Math.min(kFrameMax_s, elapsed_ms / 1000), now_ms);
    const { body, place } = this;
    this.stream.update(
      {
        position: { x: body.x, y: body.y, z: body.z },
        direction: this.direction(),
        velocity: { x: body.velocityX, y: body.velocityY, z: body.velocityZ },
        nearM: place.nearM,
        farM: place.farM,
        lodBias: 0,
      },
      now_ms,
    );
    // The last picture stays under an open map, which then moves as smoothly as it can.
    if (this.map?.isOpen !== true) this.renderer.draw(body, now_ms);
    if (now_ms - this.lastHud_ms > kHudEvery_ms) {
      this.lastHud_ms = now_ms;
      this.report();
      this.inspect(now_ms);
      this.map?.refresh();
      this.adaptResolution();
    }
  }

  private move(dt_s: number, now_ms: number): void {
    const { body, input } = this;
    const look = input.takeTurn();
    turn(body, look.yaw, look.pitch);
    if (this.flight !== null) {
      this.moveAlong(this.flight, now_ms);
      return;
    }
    const steering = { ...input.direction(), hurried: input.hurried, speedSteps: input.speedSteps };
    if (body.walking) {
      walk(body, steering, this.ground, dt_s);
    } else {
      fly(body, steering, dt_s);
      stayAbove(body, this.ground);
    }
  }

  private moveAlong(flight: Flight, now_ms: number): void {
    const t = Math.max(0, Math.min(1, (now_ms - flight.start_ms) / flight.duration_ms));
    const { body } = this;
    const at = (i: 0 | 1 | 2): number => flight.from[i] + (flight.to[i] - flight.from[i]) * t;
    const speed = (i: 0 | 1 | 2): number => (t < 1 ? ((flight.to[i] - flight.from[i]) / flight.duration_ms) * 1000 : 0);
    [body.x, body.y, body.z] = [at(0), at(1), at(2)];
    [body.velocityX, body.velocityY, body.velocityZ] = [speed(0), speed(1), speed(2)];
    if (t < 1) return;
    this.flight = null;
    this.stream.jumped();
    flight.done();
  }

  private connectionChanged(state: ConnectionState): void {
    this.connection = state;
    if (state.phase === 'open') this.hud.showNotice('', '', false);
    if (state.phase === 'refused') {
      const advice =
        state.reason === RefusedReason.Version
          ? `The server speaks version ${state.versions.join(', ')} of the protocol. Reload the page; if that does not help, viewer and server are of different releases.`
          : `${state.why}. Check the address of this page and the server's log.`;
      this.hud.showNotice('The server refused this viewer', advice, true);
    }
  }

  private reportConnection(): string {
    const state = this.connection;
    if (state.phase === 'open') return 'connected';
    if (state.phase === 'refused') return 'refused';
    if (state.phase === 'connecting') return state.attempt > 1 ? `connecting, attempt ${state.attempt}` : 'connecting';
    const seconds = Math.max(0, Math.ceil((state.retryAt_ms - performance.now()) / 1000));
    const why = state.why === '' ? '' : ` (${state.why})`;
    this.hud.showNotice(`Connection lost${why}`, `You keep what you see. Trying again ${seconds === 0 ? 'now' : `in ${seconds} s`}.`, false);
    return `lost, attempt ${state.attempt} in ${seconds} s`;
  }

  private report(): void {
    const { body, stream } = this;
    const counts = stream.store.counts();
    this.hud.showProgress(counts.ready, counts.wanted, stream.complete);
    this.hud.show({
      ...{ x: body.x, y: body.y, z: body.z, yaw: body.yaw },
      mode: body.walking ? 'walking' : `flying${this.input.speedSteps === 0 ? '' : ` ×${(2 ** this.input.speedSteps).toFixed(1)}`}`,
      ...counts,
      bytes: stream.connection.bytesReceived,
      frame_ms: this.frame_ms,
      ...this.renderer.counts,
      latency_ms: stream.lastLatency_ms,
      roundTrip_ms: stream.connection.roundTrip_ms,
      connection: this.reportConnection(),
    });
  }

  private inspect(now_ms: number): void {
    if (document.body.classList.contains('bare') || this.map?.isOpen === true) return;
    const { right, up } = this.input.pointed();
    const ray = this.renderer.rayThrough(right, up);
    this.inspector.update({ from: [this.body.x, this.body.y, this.body.z], direction: [ray.x, ray.y, ray.z] }, now_ms);
  }

  private adaptResolution(): void {
    if (this.place.pixelRatio !== null || this.frames < 90 || document.hidden) return;
    const before = this.pixelRatio;
    const most = Math.min(devicePixelRatio, 2);
    if (this.frame_ms > kSlowFrame_ms) this.pixelRatio = Math.max(kRatioLow, before * 0.85);
    else if (this.frame_ms < kFastFrame_ms) this.pixelRatio = Math.min(most, before * 1.1);
    if (Math.abs(this.pixelRatio - before) < 0.01) return;
    this.frames = 0; // judge the new resolution by its own frames
    this.resize();
  }

  private resize(): void {
    this.renderer.resize(innerWidth, innerHeight, this.pixelRatio);
  }

  private share(): void {
    const degrees = (radians: number): number => (radians * 180) / Math.PI;
    const { x, y, z, yaw, pitch } = this.body;
    history.replaceState(null, '', queryOfPlace(location.search, [x, y, z], degrees(yaw), degrees(pitch)));
    const copied = navigator.clipboard?.writeText(location.href) ?? Promise.reject(new Error('no clipboard'));
    copied.then(
      () => this.hud.say('Link copied'),
      () => this.hud.say('The address bar holds the link'),
    );
  }
}
