// The overview map: tiles of the server's map route, where the visitor is and looks, and a click that travels there.
// Owner: the main thread.

import type { GroundFacts, MapScheme } from '../protocol/server_info';
import { type MapFrame, panned, roundLength, tilesOf, toScreen, toWorld, zoomed, zoomOf } from './map_frame';
import { MapLayers } from './map_layers';
import { MapTiles, type TileSource } from './map_tiles';

const kFirstScale = 40; // metres a pixel: 40 km on a small screen
const kWheelStep = 1.25;
const kKeyStep = 1.6;
const kKeyPan = 90; // pixels
const kClickReach = 6; // pixels a click may move
const kAsk_ms = 180; // the pointer rests so long before the ground below it is asked for
/// Coarser tiles that stand in for one that is not here yet: so many zooms up.
const kStandIns = 6;

export interface MapVisitor {
  x: number;
  z: number;
  yaw: number; // radians; 0 looks along -z, which is up, and grows to the left
}

export interface MapActions {
  visitor(): MapVisitor;
  travel(x: number, z: number): void;
  ask(x: number, z: number, signal: AbortSignal): Promise<GroundFacts | null>;
  opened(open: boolean): void;
}

function element<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`index.html has no element #${id}`);
  return found as T;
}

export function lengthText(metres: number): string {
  return metres >= 1000 ? `${metres / 1000} km` : `${metres} m`;
}

export class OverviewMap {
  missing = Infinity; // tiles of this view that have not come
  private readonly panel = element('map');
  private readonly canvas = element<HTMLCanvasElement>('map-canvas');
  private readonly facts = element('map-facts');
  private readonly tiles: MapTiles;
  private readonly layers: MapLayers;
  private frame: MapFrame = { x: 0, z: 0, scale: kFirstScale, width: 1, height: 1 };
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private moved = 0; // pixels since the first finger came down
  private isDrawing = false;
  private askTimer: ReturnType<typeof setTimeout> | undefined;
  private asking = new AbortController();

  constructor(
    private readonly scheme: MapScheme,
    source: TileSource,
    private readonly actions: MapActions,
  ) {
    this.tiles = new MapTiles(source, () => this.redraw());
    this.layers = new MapLayers(element<HTMLSelectElement>('map-layer'), scheme.layers, (layer) => this.show(layer));
    element('map-open').hidden = false;
    element('map-open').addEventListener('click', () => this.toggle());
    element('map-close').addEventListener('click', () => this.toggle());
    element('map-closer').addEventListener('click', () => this.zoom(kKeyStep));
    element('map-further').addEventListener('click', () => this.zoom(1 / kKeyStep));
    element('map-me').addEventListener('click', () => this.centre());
    const { canvas } = this;
    canvas.addEventListener('pointerdown', (event) => this.pointerDown(event));
    canvas.addEventListener('pointermove', (event) => this.pointerMove(event));
    canvas.addEventListener('pointerup', (event) => this.pointerUp(event, true));
    canvas.addEventListener('pointercancel', (event) => this.pointerUp(event, false));
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    // Before the viewer's own listener, which would move the visitor.
    addEventListener('keydown', (event) => this.keyDown(event), { capture: true });
    addEventListener('resize', () => this.resize());
  }

  get isOpen(): boolean {
    return !this.panel.hidden;
  }

  toggle(): void {
    this.panel.hidden = this.isOpen;
    this.missing = Infinity;
    this.actions.opened(this.isOpen);
    if (!this.isOpen) {
      this.tiles.want(0, []);
      return;
    }
    document.exitPointerLock?.();
    this.resize();
    this.centre();
    this.canvas.focus();
  }

  get layer(): string {
    return this.tiles.layer;
  }

  private show(layer: string): void {
    this.tiles.layer = layer;
    this.missing = Infinity;
    this.canvas.focus();
    this.redraw();
  }

  /// The visitor has moved.
  refresh(): void {
    if (this.isOpen) this.redraw();
  }

  private centre(): void {
    const { x, z } = this.actions.visitor();
    this.move({ ...this.frame, x, z });
  }

  private zoom(factor: number): void {
    this.move(zoomed(this.frame, this.scheme, factor, this.frame.width / 2, this.frame.height / 2));
  }

  private move(frame: MapFrame): void {
    this.frame = frame;
    this.redraw();
  }

  private resize(): void {
    if (!this.isOpen) return;
    const { clientWidth, clientHeight } = this.canvas;
    this.canvas.width = Math.round(clientWidth * devicePixelRatio);
    this.canvas.height = Math.round(clientHeight * devicePixelRatio);
    this.move({ ...this.frame, width: clientWidth, height: clientHeight });
  }

  private keyDown(event: KeyboardEvent): void {
    if (!this.isOpen || event.ctrlKey || event.metaKey || event.altKey) return;
    // The list of layers has keys of its own.
    if (event.target instanceof HTMLSelectElement && event.code !== 'Escape') {
      event.stopPropagation();
      return;
    }
    const pans: Record<string, [number, number]> = {
      ...{ ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] },
      ...{ KeyA: [1, 0], KeyD: [-1, 0], KeyW: [0, 1], KeyS: [0, -1] },
    };
    const pan = pans[event.code];
    if (pan !== undefined) this.move(panned(this.frame, pan[0] * kKeyPan, pan[1] * kKeyPan));
    else if (event.code === 'Escape') this.toggle();
    else if (event.key === '+' || event.key === '=') this.zoom(kKeyStep);
    else if (event.key === '-') this.zoom(1 / kKeyStep);
    else if (event.code === 'Home') this.centre();
    else if (event.code === 'KeyL') this.layers.next();
    else if (event.code === 'Enter' && document.activeElement === this.canvas) this.travel(this.frame.width / 2, this.frame.height / 2);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private place(event: MouseEvent): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const { x, y } = this.place(event);
    this.move(zoomed(this.frame, this.scheme, event.deltaY < 0 ? kWheelStep : 1 / kWheelStep, x, y));
  }

  private pointerDown(event: PointerEvent): void {
    this.canvas.setPointerCapture(event.pointerId);
    if (this.pointers.size === 0) this.moved = 0;
    this.pointers.set(event.pointerId, this.place(event));
  }

  private pointerMove(event: PointerEvent): void {
    const now = this.place(event);
    const before = this.pointers.get(event.pointerId);
    if (before === undefined) {
      this.askSoon(now);
      return;
    }
    this.moved += Math.hypot(now.x - before.x, now.y - before.y);
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    this.pointers.set(event.pointerId, now);
    if (other === undefined) {
      this.move(panned(this.frame, now.x - before.x, now.y - before.y));
      return;
    }
    // Two fingers: what lies in their middle stays there, its surroundings grow with their distance.
    const distance = (p: { x: number; y: number }): number => Math.max(8, Math.hypot(p.x - other.x, p.y - other.y));
    const moved = panned(this.frame, (now.x - before.x) / 2, (now.y - before.y) / 2);
    this.move(zoomed(moved, this.scheme, distance(now) / distance(before), (now.x + other.x) / 2, (now.y + other.y) / 2));
  }

  private pointerUp(event: PointerEvent, isClick: boolean): void {
    const { x, y } = this.place(event);
    const wasOne = this.pointers.size === 1 && this.pointers.has(event.pointerId);
    this.pointers.delete(event.pointerId);
    if (isClick && wasOne && this.moved < kClickReach) this.travel(x, y);
  }

  private travel(left: number, top: number): void {
    const [x, z] = toWorld(this.frame, left, top);
    this.toggle();
    this.actions.travel(x, z);
  }

  private askSoon(at: { x: number; y: number }): void {
    clearTimeout(this.askTimer);
    this.asking.abort();
    const asking = new AbortController();
    this.asking = asking;
    this.askTimer = setTimeout(() => {
      const [x, z] = toWorld(this.frame, at.x, at.y);
      void this.actions.ask(x, z, asking.signal).then((facts) => {
        if (!asking.signal.aborted && facts !== null) this.facts.textContent = facts.text;
      });
    }, kAsk_ms);
  }

  private redraw(): void {
    if (this.isDrawing || !this.isOpen) return;
    this.isDrawing = true;
    requestAnimationFrame(() => {
      this.isDrawing = false;
      if (this.isOpen) this.draw();
    });
  }

  private draw(): void {
    const context = this.canvas.getContext('2d');
    if (context === null) return;
    const { frame, scheme } = this;
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    context.fillStyle = '#1c2733';
    context.fillRect(0, 0, frame.width, frame.height);
    const zoom = zoomOf(frame, scheme, devicePixelRatio);
    const places = tilesOf(frame, scheme, zoom);
    for (const tile of places) {
      for (let up = 0; up <= Math.min(zoom, kStandIns); ++up) {
        const image = this.tiles.find(zoom - up, tile.x >> up, tile.y >> up);
        if (image === null) continue;
        const part = scheme.tilePixels / 2 ** up;
        const mask = 2 ** up - 1;
        // Half a pixel more hides the seams that rounding would leave.
        const size = tile.size + 0.5;
        context.drawImage(image, (tile.x & mask) * part, (tile.y & mask) * part, part, part, tile.left, tile.top, size, size);
        break;
      }
    }
    this.missing = this.tiles.want(zoom, places);
    this.drawScale(context);
    this.drawVisitor(context);
  }

  private drawScale(context: CanvasRenderingContext2D): void {
    const { frame } = this;
    const metres = roundLength(frame.scale * Math.min(160, frame.width / 3));
    const length = metres / frame.scale;
    const y = frame.height - 20;
    context.fillStyle = 'rgba(18, 24, 32, 0.6)';
    context.fillRect(15, y - 1, length + 2, 5);
    context.fillStyle = 'rgba(255, 255, 255, 0.92)';
    context.fillRect(16, y, length, 3);
    context.font = '12px Inter, "Helvetica Neue", "Segoe UI", Cantarell, "DejaVu Sans", sans-serif';
    context.shadowColor = 'rgba(10, 20, 30, 0.9)';
    context.shadowBlur = 5;
    context.fillText(lengthText(metres), 16, y - 7);
    context.shadowBlur = 0;
  }

  private drawVisitor(context: CanvasRenderingContext2D): void {
    const { x, z, yaw } = this.actions.visitor();
    const [left, top] = toScreen(this.frame, x, z);
    context.save();
    context.translate(left, top);
    context.rotate(-yaw);
    const cone = context.createRadialGradient(0, 0, 4, 0, 0, 46);
    cone.addColorStop(0, 'rgba(255, 255, 255, 0.55)');
    cone.addColorStop(1, 'rgba(255, 255, 255, 0)');
    context.fillStyle = cone;
    context.beginPath();
    context.moveTo(0, 0);
    context.arc(0, 0, 46, -Math.PI / 2 - 0.55, -Math.PI / 2 + 0.55);
    context.fill();
    context.beginPath();
    context.moveTo(0, -11);
    context.lineTo(7.5, 9);
    context.lineTo(0, 5);
    context.lineTo(-7.5, 9);
    context.closePath();
    context.fillStyle = '#ffffff';
    context.strokeStyle = 'rgba(18, 24, 32, 0.85)';
    context.lineWidth = 3;
    context.lineJoin = 'round';
    context.stroke();
    context.fill();
    context.restore();
  }
}
