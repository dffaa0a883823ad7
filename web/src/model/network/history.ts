// The undo history of the text. Quick successive edits of one field are one step.

export interface Step {
  readonly text: string
  /** The edited field; quick successive steps with the same key are merged. */
  readonly key: string
  readonly at_ms: number
}

/** After a pause of this length the next edit is a new step. */
const PAUSE_MS = 1500
const MOST_STEPS = 200

export class History {
  readonly #past: readonly Step[]
  readonly #future: readonly string[]

  private constructor(
    readonly text: string,
    past: readonly Step[],
    future: readonly string[],
  ) {
    this.#past = past
    this.#future = future
  }

  static of(text: string): History {
    return new History(text, [], [])
  }

  get canUndo(): boolean {
    return this.#past.length > 0
  }

  get canRedo(): boolean {
    return this.#future.length > 0
  }

  /** Replaces the text with another one. */
  then(text: string, key: string, at_ms: number): History {
    if (text === this.text) return this
    const last = this.#past.at(-1)
    const goesOn = last !== undefined && key !== '' && last.key === key && at_ms - last.at_ms < PAUSE_MS
    const kept = goesOn ? this.#past.slice(0, -1) : this.#past
    const before = goesOn ? last.text : this.text
    return new History(text, [...kept, { text: before, key, at_ms }].slice(-MOST_STEPS), [])
  }

  undo(): History {
    const last = this.#past.at(-1)
    if (last === undefined) return this
    return new History(last.text, this.#past.slice(0, -1), [this.text, ...this.#future])
  }

  redo(): History {
    const [next, ...rest] = this.#future
    if (next === undefined) return this
    return new History(next, [...this.#past, { text: this.text, key: '', at_ms: 0 }], rest)
  }
}
