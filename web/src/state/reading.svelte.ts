// A value that a view reads from the service, such as a list. If a later read fails, the last value
// stays, together with the problem.

import { refusal, type ProblemError } from '../api/problem'

export class Reading<T> {
  /** The last value; undefined until there is one. */
  value = $state.raw<T>()
  /** Why the last read failed. */
  problem = $state.raw<ProblemError>()

  constructor(private readonly ask: () => Promise<T>) {}

  async read(): Promise<void> {
    try {
      this.value = await this.ask()
      this.problem = undefined
    } catch (cause) {
      this.problem = refusal(cause)
    }
  }

  /**
   * Reads the value now and periodically, because other users change it too, until the returned
   * function is called.
   */
  repeat(every_ms: number): () => void {
    void this.read()
    const timer = setInterval(() => void this.read(), every_ms)
    return () => clearInterval(timer)
  }
}
