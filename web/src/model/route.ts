// Addresses within the console, as the hash of its page: `#/day/ID/now?at=07:10:00`. A link
// reproduces what its author saw; a token is never part of it.

export const dayViews = ['now', 'timeline', 'what-if', 'log', 'replay'] as const
export const otherViews = ['days', 'replay', 'networks', 'studies'] as const

export type DayView = (typeof dayViews)[number]
export type OtherView = (typeof otherViews)[number]

/**
 * A view of a day, or one without a day, with its parameters. `isUnknown` is set if the address
 * names no existing view.
 */
export type Route =
  | { view: DayView; day: string; params: Readonly<Record<string, string>>; isUnknown?: boolean }
  | { view: OtherView; day?: undefined; params: Readonly<Record<string, string>>; isUnknown?: boolean }

/** Former addresses of views, which old links may contain. */
const formerNames: Readonly<Record<string, OtherView>> = { editor: 'networks' }

export const home: Route = { view: 'days', params: {} }

/** Parses a hash. An unknown address leads to the list of days, or to the day's current view. */
export function parseRoute(hash: string): Route {
  const [path = '', query = ''] = hash.replace(/^#\/?/, '').split('?', 2)
  const [first = '', second = '', third = ''] = path.split('/').map(decoded)
  const params = Object.fromEntries(new URLSearchParams(query))
  if (first === 'day' && second !== '') {
    const view = dayViews.find((one) => one === third)
    const route = { view: view ?? 'now', day: second, params } as const
    return view === undefined && third !== '' ? { ...route, isUnknown: true } : route
  }
  const view = otherViews.find((one) => one === (formerNames[first] ?? first))
  if (view !== undefined) return { view, params }
  return path === '' ? home : { ...home, isUnknown: true }
}

/** The hash of a route. */
export function hashOf({ view, day, params }: Route): string {
  const path = day === undefined ? view : `day/${encodeURIComponent(day)}/${view}`
  const query = new URLSearchParams(params).toString().replaceAll('%3A', ':')
  return `#/${path}${query === '' ? '' : `?${query}`}`
}

function decoded(part: string): string {
  try {
    return decodeURIComponent(part)
  } catch {
    return ''
  }
}
