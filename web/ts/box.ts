// Positions on the canvas.

/** Left, top, width and height, in CSS pixels. */
export type Box = readonly [left: number, top: number, width: number, height: number];

/** Converts a box from the module. */
export function boxOf(numbers: Float32Array | undefined): Box | null {
  return numbers === undefined ? null : ([...numbers] as unknown as Box);
}
