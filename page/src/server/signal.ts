// SPDX-License-Identifier: Apache-2.0

export type Unsubscribe = () => void;

/** An observable value: a listener is called at once if there is a value, and on changes. */
export class Signal<T> {
  private readonly listeners = new Set<(value: T) => void>();

  constructor(private current?: T) {}

  get value(): T | undefined {
    return this.current;
  }

  set(value: T): void {
    this.current = value;
    this.emit(value);
  }

  /** Calls the listeners without storing the value. */
  emit(value: T): void {
    for (const listener of [...this.listeners]) listener(value);
  }

  /** Bound, so that it can be passed on. */
  readonly on = (listener: (value: T) => void): Unsubscribe => {
    this.listeners.add(listener);
    if (this.current !== undefined) listener(this.current);
    return () => this.listeners.delete(listener);
  };

  /** Resolves with the first value. */
  first(): Promise<T> {
    return new Promise((resolve) => {
      const end = this.on((value) => {
        resolve(value);
        queueMicrotask(() => end());
      });
    });
  }
}
