import { expect, it } from 'vitest'
import { hashOf, home, parseRoute, type Route } from './route'

it('survives a round trip through its hash', () => {
  const routes: Route[] = [
    home,
    { view: 'networks', params: { network: 'new-york' } },
    { view: 'now', day: '1a2063eef97e', params: { at: '07:10:00', aircraft: 'A 01/ä' } },
    { view: 'replay', day: 'x/y', params: {} },
    { view: 'replay', params: {} },
  ]
  for (const route of routes) expect(parseRoute(hashOf(route))).toEqual(route)
})

it('accepts the former address of the networks', () => {
  expect(parseRoute('#/editor?network=new-york')).toEqual({
    view: 'networks',
    params: { network: 'new-york' },
  })
})

it('writes times readably in links', () => {
  expect(hashOf({ view: 'now', day: 'd', params: { at: '07:10:00' } })).toBe('#/day/d/now?at=07:10:00')
})

it('marks unknown addresses, and leads to the days or to the day’s current view', () => {
  for (const hash of ['', '#', '#/']) expect(parseRoute(hash)).toEqual(home)
  for (const hash of ['#/nowhere', '#/day', '#/day/', '#/%E0%A4%A'])
    expect(parseRoute(hash)).toEqual({ ...home, isUnknown: true })
  expect(parseRoute('#/day/d')).toEqual({ view: 'now', day: 'd', params: {} })
  expect(parseRoute('#/day/d/nowhere')).toEqual({ view: 'now', day: 'd', params: {}, isUnknown: true })
})
