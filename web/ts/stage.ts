// The canvas and its input. eframe would consume keys and touches that belong to the page.

import type { Instance } from './instance';
import { LoadError } from './module';
import { SUMMARY } from './parts';
import { TouchGate } from './touch';

/** A canvas on which an instance runs. */
export class Stage {
  readonly canvas: HTMLCanvasElement;
  readonly #element: HTMLElement;
  readonly #instance: Instance;
  readonly #listening = new AbortController();

  readonly #context: WebGL2RenderingContext;

  /** Puts the canvas on the page; throws a LoadError if the browser cannot draw. */
  constructor(element: HTMLElement, instance: Instance, label: string, onContextLost: () => void) {
    this.#element = element;
    this.#instance = instance;
    this.canvas = document.createElement('canvas');
    // eframe gets the same context, because a canvas has only one.
    const context = this.canvas.getContext('webgl2');
    if (context === null) throw new LoadError('this browser has no WebGL 2');
    this.#context = context;
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', label);
    this.canvas.setAttribute('aria-describedby', SUMMARY);
    this.canvas.style.height = `${Math.max(element.clientHeight, 1)}px`;
    element.append(this.canvas);
    instance.frames.canvas = this.canvas;
    this.#listen(onContextLost);
  }

  /** Whether the browser has taken the context away. */
  get isLost(): boolean {
    return this.#context.isContextLost();
  }

  /** Runs the instance on the canvas. */
  async start(): Promise<void> {
    const element = this.#element;
    // eframe focuses its text field as it starts. An inert element cannot be focused.
    element.inert = true;
    try {
      await this.#instance.start(this.canvas);
    } finally {
      element.inert = false;
    }
    // Tab stops only at the native controls.
    this.canvas.tabIndex = -1;
    for (const agent of element.querySelectorAll('input')) {
      agent.tabIndex = -1;
      agent.setAttribute('aria-hidden', 'true');
    }
  }

  /** Removes the canvas and releases the context at once, without waiting for the garbage collector. */
  dispose(): void {
    this.#listening.abort();
    this.#context.getExtension('WEBGL_lose_context')?.loseContext();
    this.canvas.remove();
    // A start that panicked never resolves, so its cleanup does not run.
    this.#element.inert = false;
    for (const agent of this.#element.querySelectorAll('input')) agent.remove();
  }

  #listen(onContextLost: () => void): void {
    const { signal } = this.#listening;
    const wake = (): void => this.#instance.frames.wake();
    const capture = { capture: true, passive: true, signal };
    const element = this.#element;
    const dragsAt = (x: number, y: number): boolean =>
      this.#instance.crash() === undefined && this.#instance.use((widget) => widget.dragsAt(x, y));
    new TouchGate(element, this.canvas, { dragsAt, letGo: () => this.#release() }, signal);
    for (const type of ['pointerdown', 'pointermove', 'pointerleave', 'touchstart', 'wheel', 'focusin']) {
      element.addEventListener(type, wake, capture);
    }
    // A drag may end anywhere on the page.
    for (const type of ['pointerup', 'touchend', 'blur']) {
      window.addEventListener(type, wake, capture);
    }
    element.addEventListener('pointercancel', () => this.#release(), capture);
    element.addEventListener('touchcancel', (event) => this.#touchCancel(event), capture);
    for (const type of ['keydown', 'keyup'] as const) {
      element.addEventListener(type, (event) => this.#key(event), { capture: true, signal });
    }
    this.canvas.addEventListener(
      'webglcontextlost',
      (event) => {
        event.preventDefault();
        onContextLost();
      },
      { signal },
    );
  }

  #touchCancel(event: TouchEvent): void {
    // eframe would cancel events that cannot be cancelled any more, for which browsers log an error.
    if (!event.cancelable) Object.defineProperty(event, 'preventDefault', { value: () => {} });
    this.#release();
  }

  #release(): void {
    if (this.#instance.crash() !== undefined) return;
    this.#instance.use((widget) => widget.releaseDrags());
    this.#instance.frames.wake();
  }

  /** All keys belong to the page: egui would take them. */
  #key(event: KeyboardEvent): void {
    event.stopImmediatePropagation();
    // Shortcuts of the page still work: next slide, search.
    const { host } = this.#element.getRootNode() as ShadowRoot;
    if (!host.dispatchEvent(new KeyboardEvent(event.type, event))) event.preventDefault();
  }
}
