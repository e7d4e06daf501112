// What the visitor wants to do, from keyboard, mouse and touch, as plain numbers. Owner: the main thread.

const kMouseTurn = 0.0022; // radians per pixel
const kTouchTurn = 0.0048;
const kStickReach = 56; // pixels to full speed
/// The left part of a touch screen steers, the rest looks.
const kStickShare = 0.4;

export interface InputActions {
  toggleWalk(): void;
  toggleHelp(): void;
  toggleHud(): void;
  share(): void;
  toggleWire(): void;
  toggleSeams(): void;
  toggleMap(): void;
  jump(): void;
}

export class Input {
  turnYaw = 0; // radians since the last frame; see takeTurn
  turnPitch = 0;
  /// 2^speedSteps multiplies the flying speed.
  speedSteps = 0;
  private readonly down = new Set<string>();
  private stick: { id: number; x: number; y: number; dx: number; dy: number } | null = null;
  private look: { id: number; x: number; y: number } | null = null;
  private dragging = false;
  /// Of the mouse over the picture, 0..1 from the lower left; the middle while it is locked or there is none.
  private readonly pointer = { right: 0.5, up: 0.5 };

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly knob: HTMLElement,
    private readonly actions: InputActions,
  ) {
    addEventListener('keydown', (event) => this.keyDown(event));
    addEventListener('keyup', (event) => this.down.delete(event.code));
    addEventListener('blur', () => this.down.clear());
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    canvas.addEventListener('pointerdown', (event) => this.pointerDown(event));
    canvas.addEventListener('pointermove', (event) => this.pointerMove(event));
    canvas.addEventListener('pointerup', (event) => this.pointerUp(event));
    canvas.addEventListener('pointercancel', (event) => this.pointerUp(event));
  }

  /// -1 .. 1 each: to the right, up, ahead.
  direction(): { right: number; up: number; ahead: number } {
    const axis = (plus: string[], minus: string[]): number =>
      Number(plus.some((code) => this.down.has(code))) - Number(minus.some((code) => this.down.has(code)));
    const right = axis(['KeyD', 'ArrowRight'], ['KeyA', 'ArrowLeft']) + (this.stick?.dx ?? 0);
    const ahead = axis(['KeyW', 'ArrowUp'], ['KeyS', 'ArrowDown']) - (this.stick?.dy ?? 0);
    return { right, ahead, up: axis(['KeyE', 'PageUp'], ['KeyQ', 'PageDown']) };
  }

  get hurried(): boolean {
    return this.down.has('ShiftLeft') || this.down.has('ShiftRight');
  }

  pointed(): { right: number; up: number } {
    return document.pointerLockElement === this.canvas ? { right: 0.5, up: 0.5 } : { ...this.pointer };
  }

  /// Keys that are down when another listener takes over would stay down.
  release(): void {
    this.down.clear();
  }

  takeTurn(): { yaw: number; pitch: number } {
    const turn = { yaw: this.turnYaw, pitch: this.turnPitch };
    this.turnYaw = 0;
    this.turnPitch = 0;
    return turn;
  }

  private keyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.code === 'Space' || event.code.startsWith('Arrow') || event.code.startsWith('Page')) event.preventDefault();
    this.down.add(event.code);
    if (event.code === 'Space') this.actions.jump();
    if (event.repeat) return;
    if (event.code === 'KeyF') this.actions.toggleWalk();
    if (event.code === 'KeyH' || event.key === '?') this.actions.toggleHelp();
    if (event.code === 'KeyU') this.actions.toggleHud();
    if (event.code === 'KeyC') this.actions.share();
    if (event.code === 'KeyG') this.actions.toggleWire();
    if (event.code === 'KeyL') this.actions.toggleSeams();
    if (event.code === 'KeyM') this.actions.toggleMap();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    this.speedSteps = Math.max(-4, Math.min(6, this.speedSteps - Math.sign(event.deltaY) * 0.5));
  }

  private pointerDown(event: PointerEvent): void {
    if (event.pointerType === 'mouse') {
      this.dragging = true;
      // Refused without a gesture or in a frame without permission: dragging works all the same.
      const locked = this.canvas.requestPointerLock() as Promise<void> | undefined;
      locked?.catch(() => undefined);
      return;
    }
    this.canvas.setPointerCapture(event.pointerId);
    if (event.clientX < innerWidth * kStickShare && this.stick === null) {
      this.stick = { id: event.pointerId, x: event.clientX, y: event.clientY, dx: 0, dy: 0 };
      this.showKnob();
    } else if (this.look === null) {
      this.look = { id: event.pointerId, x: event.clientX, y: event.clientY };
    }
  }

  private pointerMove(event: PointerEvent): void {
    if (event.pointerType === 'mouse') {
      this.pointer.right = event.clientX / innerWidth;
      this.pointer.up = 1 - event.clientY / innerHeight;
      if (document.pointerLockElement === this.canvas || this.dragging) this.turn(event.movementX, event.movementY, kMouseTurn);
      return;
    }
    if (this.stick?.id === event.pointerId) {
      const reach = (pixels: number): number => Math.max(-1, Math.min(1, pixels / kStickReach));
      this.stick.dx = reach(event.clientX - this.stick.x);
      this.stick.dy = reach(event.clientY - this.stick.y);
      this.showKnob();
    } else if (this.look?.id === event.pointerId) {
      this.turn(event.clientX - this.look.x, event.clientY - this.look.y, kTouchTurn);
      this.look.x = event.clientX;
      this.look.y = event.clientY;
    }
  }

  private pointerUp(event: PointerEvent): void {
    this.dragging = false;
    if (this.stick?.id === event.pointerId) this.stick = null;
    if (this.look?.id === event.pointerId) this.look = null;
    this.showKnob();
  }

  private turn(dx: number, dy: number, per: number): void {
    this.turnYaw -= dx * per;
    this.turnPitch -= dy * per;
  }

  private showKnob(): void {
    const { stick, knob } = this;
    knob.hidden = stick === null;
    if (stick === null) return;
    knob.style.left = `${stick.x}px`;
    knob.style.top = `${stick.y}px`;
    knob.style.setProperty('--dx', `${stick.dx * kStickReach}px`);
    knob.style.setProperty('--dy', `${stick.dy * kStickReach}px`);
  }
}
