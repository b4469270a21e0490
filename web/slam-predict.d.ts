// Types of <slam-predict>, the element that `slam-widgets/predict` defines.

/** What a reader committed to, and what came of it. */
export interface Prediction {
  /** The name of the widget that was asked: `w16.1`. */
  widget: string;
  /** The choice or the number, as the reader gave it. */
  prediction: string;
  /** The widget's verdict, or its number as text. */
  result: string;
  correct: boolean;
  /** Prediction minus result; null for choices. */
  gap: number | null;
}

export interface SlamPredictEvents {
  /** The reader committed, and the widget has answered. */
  'slam-predict': CustomEvent<Prediction>;
}

/** Set up by its attributes: `widget`, `state`, and for a number `fact`, `tolerance`, `unit`. */
export declare class SlamPredict extends HTMLElement {
  addEventListener<K extends keyof SlamPredictEvents>(
    type: K,
    listener: (this: SlamPredict, event: SlamPredictEvents[K]) => void,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(
    type: string,
    listener: EventListenerOrEventListenerObject,
    options?: boolean | AddEventListenerOptions,
  ): void;
}

declare global {
  interface HTMLElementTagNameMap {
    'slam-predict': SlamPredict;
  }
}
