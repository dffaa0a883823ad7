// The session's token and its permissions. The token is kept in the tab's session storage and never
// in an address, which logs and histories would store.

import { Service } from '../api/client'
import { ProblemError, UNAUTHORIZED } from '../api/problem'
import type { ServiceInfo } from '../api/types'

const KEY = 'vertifleet-token'

class Session {
  #token = $state<string | undefined>(sessionStorage.getItem(KEY) ?? undefined)
  /** The service's description of itself and of the token; undefined until it is known. */
  info = $state.raw<ServiceInfo>()
  /** Whether the service requires a token, or another one. */
  needsToken = $state(false)
  readonly service = new Service({ token: () => this.#token, fetch: (request) => this.#watched(request) })

  get hasToken(): boolean {
    return this.#token !== undefined
  }

  get mayDispatch(): boolean {
    return this.info !== undefined && this.info.role !== 'read'
  }

  get mayAdminister(): boolean {
    return this.info?.role === 'admin'
  }

  /** Reads the service's description and the user's permissions. */
  async begin(): Promise<void> {
    try {
      this.info = await this.service.info()
      this.needsToken = false
    } catch (problem) {
      if (problem instanceof ProblemError && problem.status === UNAUTHORIZED) return
      throw problem
    }
  }

  async signIn(token: string): Promise<void> {
    this.#keep(token)
    await this.begin()
    if (this.needsToken) this.#keep(undefined)
  }

  signOut(): void {
    this.#keep(undefined)
    this.info = undefined
    this.needsToken = true
  }

  #keep(token: string | undefined): void {
    this.#token = token
    if (token === undefined) sessionStorage.removeItem(KEY)
    else sessionStorage.setItem(KEY, token)
  }

  async #watched(request: Request): Promise<Response> {
    const response = await fetch(request)
    if (response.status === UNAUTHORIZED) this.needsToken = true
    return response
  }
}

export const session = new Session()
