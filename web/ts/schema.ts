// The parameter lists of the widgets, which the build exports from the core.

import schemas from '../pkg/schema.json';

/** The picture's height at each width, in CSS pixels, by ascending width. */
export type Heights = readonly (readonly [width: number, height: number])[];

export interface OptionSpec {
  id: string;
  label: string;
}

export interface ParamSpec {
  id: string;
  label: string;
  unit: string;
  kind: 'slider' | 'timeline' | 'seed' | 'choice' | 'switch' | 'text';
  min: number;
  /** For a text, the largest number of characters. */
  max: number;
  step: number;
  decimals: number;
  default: number;
  options: OptionSpec[];
  help: string;
}

export interface ButtonSpec {
  id: string;
  label: string;
  help: string;
}

/** `ArrowLeft`, `Control+z`. */
export interface KeySpec {
  key: string;
  button: string;
}

export interface WidgetSpec {
  id: string;
  name: string;
  /** The question that the widget asks. */
  title: string;
  /** What the answer shows. */
  claim: string;
  /** The gesture that answers. */
  gesture: string;
  notice: string[];
  params: ParamSpec[];
  buttons: ButtonSpec[];
  presets: ButtonSpec[];
  /** Keys that press a button while one of these buttons has the focus. */
  keys: KeySpec[];
  /** The controls that are visible before "More". */
  opening: string[];
  summary: string;
  /** Whether the widget accepts logs. A widget with a text parameter accepts a file for it in any case. */
  takesFiles: boolean;
  heights: Heights;
}

/** The JSON import has no tuple types, only arrays. */
export const widgets = schemas as unknown as WidgetSpec[];

export function findWidget(name: string): WidgetSpec | undefined {
  return widgets.find((widget) => widget.id === name);
}

export function findParam(widget: WidgetSpec, id: string): ParamSpec | undefined {
  return widget.params.find((param) => param.id === id);
}

/** The parameter names of all widgets, without duplicates. */
export function allParamIds(): string[] {
  return [...new Set(widgets.flatMap((widget) => widget.params.map((param) => param.id)))];
}
