// The recording of a robot's drive, as the worker writes it. The browser may keep what is in a blob on disk.

/** Its file: `RECORDING` of crates/robots/robot_io/src/live.rs. */
export const RECORDING = 'recording.mcap';
/** Pieces of this many bytes together become a blob. */
const BLOB_BYTES = 1 << 22;

export class Recording {
  #parts: BlobPart[] = [];
  #loose: Uint8Array<ArrayBuffer>[] = [];
  #looseBytes = 0;

  add(bytes: Uint8Array<ArrayBuffer>): void {
    this.#loose.push(bytes);
    this.#looseBytes += bytes.length;
    if (this.#looseBytes < BLOB_BYTES) return;
    this.#parts.push(new Blob(this.#loose));
    this.#loose = [];
    this.#looseBytes = 0;
  }

  /** All so far. */
  file(): File {
    return new File([...this.#parts, ...this.#loose], RECORDING);
  }
}
