// What a view reads of the service as a whole, such as a list: what was read last stays when it cannot be read again, beside why.

import { refusal, type ProblemError } from '../api/problem'

export class Reading<T> {
  /** What was read last; undefined until it was. */
  value = $state.raw<T>()
  /** Why it could not be read the last time. */
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

  /** Reads it now and from time to time, since others change it too, until the returned function is called. */
  repeat(every_ms: number): () => void {
    void this.read()
    const timer = setInterval(() => void this.read(), every_ms)
    return () => clearInterval(timer)
  }
}
