// Types of <slam-predict> and <slam-answers>, the elements that `slam-widgets/predict` defines.

/** The reader's prediction, and the result. */
export interface Prediction {
  /** The id of the exercise, `16.5a`; null if the question has none. */
  exercise: string | null;
  /** The name or token that gave the exercise its seed; empty for the chapter's. */
  student: string;
  /** Number of answers to this exercise, with this one. */
  attempts: number;
  /** Moment of the answer, ISO 8601. */
  time: string;
  /** The name of the widget in question: `w16.1`. */
  widget: string;
  /** The state of the widget, with a student's own seed: `noise=4&t=129&seed=7`. */
  state: string;
  /** The reader's choice or number. */
  prediction: string;
  /** The widget's verdict, or its number as text. */
  result: string;
  /** Whether the prediction came true. A wrong guess is no mistake. */
  correct: boolean;
  /** The choice that is right, if one is; else the number. */
  right: string | null;
  /** Prediction minus result; null for choices. */
  gap: number | null;
}

export interface SlamPredictEvents {
  /** The reader has answered, and so has the widget. */
  'slam-predict': CustomEvent<Prediction>;
}

/**
 * Set up by its attributes: `exercise`, `widget`, `state`, for a number `fact`, `tolerance`, `unit`, and for
 * personal tasks `student`.
 */
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

/** The reader's name or token, and the file of the answers on this page. */
export declare class SlamAnswers extends HTMLElement {}

declare global {
  interface HTMLElementTagNameMap {
    'slam-predict': SlamPredict;
    'slam-answers': SlamAnswers;
  }
  interface DocumentEventMap {
    'slam-predict': CustomEvent<Prediction>;
  }
}
