// The current view: the hash of the page, as a route.

import { hashOf, parseRoute, type DayView, type OtherView, type Route } from '../model/route'

class Router {
  route = $state.raw<Route>(parseRoute(location.hash))

  constructor() {
    addEventListener('hashchange', () => (this.route = parseRoute(location.hash)))
  }

  go(route: Route): void {
    location.hash = hashOf(route)
  }

  /** Opens a view of the current day, or one without a day. */
  goTo(view: DayView | OtherView): void {
    const { day } = this.route
    if (view === 'days' || view === 'networks' || view === 'studies') this.go({ view, params: {} })
    else if (day !== undefined) this.go({ view, day, params: {} })
    else if (view === 'replay') this.go({ view, params: {} })
  }

  /** Stores parameters in the address without a step in the history; an absent value is removed. */
  remember(params: Record<string, string | undefined>): void {
    const merged = Object.entries({ ...this.route.params, ...params })
    const kept = Object.fromEntries(merged.filter((one): one is [string, string] => one[1] !== undefined))
    const hash = hashOf({ ...this.route, params: kept })
    history.replaceState(history.state, '', hash)
    this.route = parseRoute(hash)
  }
}

export const router = new Router()
