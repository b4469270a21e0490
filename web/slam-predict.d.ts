// Types of <slam-predict>, the element that `slam-widgets/predict` defines.

/** The reader's prediction, and the result. */
export interface Prediction {
  /** The name of the widget in question: `w16.1`. */
  widget: string;
  /** The reader's choice or number. */
  prediction: string;
  /** The widget's verdict, or its number as text. */
  result: string;
  correct: boolean;
  /** Prediction minus result; null for choices. */
  gap: number | null;
}

export interface SlamPredictEvents {
  /** The reader has answered, and so has the widget. */
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
