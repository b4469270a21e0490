// The canvas with what belongs to it: input that eframe would take from the page is given back.

import type { Instance } from './instance';
import { LoadError } from './module';

/** A canvas on which an instance runs. */
export class Stage {
  readonly canvas: HTMLCanvasElement;
  readonly #element: HTMLElement;
  readonly #instance: Instance;
  readonly #listening = new AbortController();

  private constructor(element: HTMLElement, canvas: HTMLCanvasElement, instance: Instance) {
    this.#element = element;
    this.canvas = canvas;
    this.#instance = instance;
  }

  static async start(
    element: HTMLElement,
    instance: Instance,
    label: string,
    onContextLost: () => void,
  ): Promise<Stage> {
    const canvas = document.createElement('canvas');
    // A canvas has one context: eframe gets this one.
    if (canvas.getContext('webgl2') === null) throw new LoadError('this browser draws no WebGL 2');
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', label);
    canvas.style.height = `${Math.max(element.clientHeight, 1)}px`;
    element.append(canvas);
    const stage = new Stage(element, canvas, instance);
    stage.#listen(onContextLost);
    // eframe focuses its text field as it starts. What is inert cannot be focused.
    element.inert = true;
    try {
      await instance.start(canvas);
    } catch (error) {
      stage.dispose();
      throw error;
    } finally {
      element.inert = false;
    }
    // The Tab key stops at the native controls, never in here.
    canvas.tabIndex = -1;
    for (const agent of element.querySelectorAll('input')) {
      agent.tabIndex = -1;
      agent.setAttribute('aria-hidden', 'true');
    }
    return stage;
  }

  /** Takes the canvas away and gives the context back at once, without waiting for the collector. */
  dispose(): void {
    this.#listening.abort();
    const context = this.canvas.getContext('webgl2');
    context?.getExtension('WEBGL_lose_context')?.loseContext();
    this.canvas.remove();
    for (const agent of this.#element.querySelectorAll('input')) agent.remove();
  }

  #listen(onContextLost: () => void): void {
    const { signal } = this.#listening;
    const wake = (): void => this.#instance.frames.wake();
    const capture = { capture: true, passive: true, signal };
    const element = this.#element;
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
    // eframe would cancel what cannot be cancelled any more, for which browsers log an error.
    if (!event.cancelable) Object.defineProperty(event, 'preventDefault', { value: () => {} });
    this.#release();
  }

  #release(): void {
    if (this.#instance.crash() !== undefined) return;
    this.#instance.use((widget) => widget.releaseDrags());
    this.#instance.frames.wake();
  }

  /** egui hears keys while one types into a field of its own; Tab and all else are the page's. */
  #key(event: KeyboardEvent): void {
    this.#instance.frames.wake();
    const typing =
      this.#instance.crash() === undefined &&
      this.#instance.use((widget) => widget.wantsKeyboard());
    if (event.key !== 'Tab' && typing) return;
    event.stopImmediatePropagation();
    // The page's own shortcuts still hear it: the next slide, the search field.
    const { host } = this.#element.getRootNode() as ShadowRoot;
    if (!host.dispatchEvent(new KeyboardEvent(event.type, event))) event.preventDefault();
  }
}
