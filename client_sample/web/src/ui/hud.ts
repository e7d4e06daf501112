// Words over the picture: figures, progress, help, and what is wrong with what to do about it. Owner: the main thread.

export interface HudFigures {
  x: number;
  y: number;
  z: number;
  yaw: number; // radians
  mode: string;
  held: number;
  wanted: number;
  ready: number;
  drawn: number;
  bytes: number;
  frame_ms: number;
  drawCalls: number;
  triangles: number;
  latency_ms: number;
  roundTrip_ms: number;
  connection: string;
}

const kWinds = ['N', 'NW', 'W', 'SW', 'S', 'SE', 'E', 'NE'];

function thousands(value: number): string {
  return Math.round(value).toLocaleString('en').replaceAll(',', '\u2009');
}

export function byteText(bytes: number): string {
  if (bytes < 1024) return `${bytes} B`;
  if (bytes < 1024 * 1024) return `${(bytes / 1024).toFixed(0)} KiB`;
  return `${(bytes / 1024 / 1024).toFixed(1)} MiB`;
}

function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`index.html has no element #${id}`);
  return found;
}

export class Hud {
  private readonly figures = element('figures');
  private readonly progress = element('progress');
  private readonly bar = element('progress-bar');
  private readonly progressText = element('progress-text');
  private readonly notice = element('notice');
  private readonly help = element('help');
  private readonly toast = element('toast');
  private readonly under = element('under');
  private toastTimer: ReturnType<typeof setTimeout> | undefined;
  private firstViewDone = false;

  constructor(visible: boolean) {
    document.body.classList.toggle('bare', !visible);
    element('help-close').addEventListener('click', () => this.toggleHelp());
    element('help-open').addEventListener('click', () => this.toggleHelp());
  }

  show(f: HudFigures): void {
    const wind = kWinds[(Math.round((f.yaw / (2 * Math.PI)) * 8) + 16) % 8]!;
    const rows: [string, string][] = [
      ['place', `${thousands(f.x)}  ${thousands(f.y)}  ${thousands(f.z)} m · ${wind}`],
      ['mode', f.mode],
      ['chunks', `${thousands(f.held)} held · ${thousands(f.wanted)} wanted · ${thousands(f.drawn)} drawn`],
      ['received', byteText(f.bytes)],
      ['frame', `${f.frame_ms.toFixed(1)} ms · ${thousands(f.drawCalls)} calls · ${thousands(f.triangles)} triangles`],
      ['latency', `${f.latency_ms.toFixed(0)} ms last chunk · ${f.roundTrip_ms.toFixed(0)} ms round trip`],
      ['server', f.connection],
    ];
    this.figures.replaceChildren(
      ...rows.flatMap(([name, value]) => {
        const term = document.createElement('dt');
        const text = document.createElement('dd');
        term.textContent = name;
        text.textContent = value;
        return [term, text];
      }),
    );
  }

  /// Progress of the first view only: later ones refine what is already there.
  showProgress(ready: number, wanted: number, complete: boolean): void {
    if (this.firstViewDone) return;
    this.firstViewDone = complete;
    this.progress.classList.toggle('done', complete);
    this.bar.style.transform = `scaleX(${wanted === 0 ? 0 : ready / wanted})`;
    this.progressText.textContent = wanted === 0 ? 'Looking for land' : `Raising mountains · ${Math.floor((100 * ready) / wanted)} %`;
  }

  /// What is wrong and what to do. `grave` covers the picture. Empty title: all is well.
  showNotice(title: string, advice: string, grave: boolean): void {
    this.notice.hidden = title === '';
    this.notice.classList.toggle('grave', grave);
    element('notice-title').textContent = title;
    element('notice-advice').textContent = advice;
    if (grave) this.progress.classList.add('done');
  }

  say(text: string): void {
    clearTimeout(this.toastTimer);
    this.toast.textContent = text;
    this.toast.classList.add('shown');
    this.toastTimer = setTimeout(() => this.toast.classList.remove('shown'), 2200);
  }

  /// What lies under the pointer; empty for the sky.
  showUnder(text: string): void {
    this.under.textContent = text;
    this.under.hidden = text === '';
  }

  toggleHelp(): void {
    this.help.hidden = !this.help.hidden;
  }

  toggleFigures(): void {
    document.body.classList.toggle('bare');
  }
}
