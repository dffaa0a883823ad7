// The service's policies, read again by each view that offers them.

import { Reading } from './reading.svelte'
import { session } from './session.svelte'
import { toasts } from './toasts.svelte'

class Policies {
  readonly #list = new Reading(() => session.service.policies())

  get names(): string[] {
    return this.#list.value?.map(({ name }) => name) ?? []
  }

  async read(): Promise<void> {
    await this.#list.read()
    if (this.#list.problem !== undefined) toasts.fail(this.#list.problem)
  }
}

export const policies = new Policies()
