import { describe, expect, it } from 'vitest'
import { outlook, scenario as liveScenario } from './fixtures/liveDay'
import { requestOf, compared, eventsOf, freshId, routesOf, scenarioWith, type Change } from './whatif'

const changes: Change[] = [
  { id: 1, kind: 'event', event: { type: 'closed', routes: routesOf('V1', ''), until: '12:00:00' } },
  { id: 2, kind: 'aircraft', aircraft: { id: 'A06', at: 'East' } },
  { id: 3, kind: 'stands', vertiport: 'North', stands: 9 },
]

describe('a what-if', () => {
  it('requests exactly the changes', () => {
    expect(requestOf(changes, 'rolling')).toEqual({
      events: [{ type: 'closed', routes: { vertiport: 'V1' }, until: '12:00:00' }],
      aircraft: [{ id: 'A06', at: 'East' }],
      stands: { North: 9 },
      policy: 'rolling',
    })
    expect(requestOf([], '')).toEqual({})
    expect(eventsOf(changes)).toHaveLength(1)
  })

  it('is shown with its fleet and stands', () => {
    const scenario = scenarioWith(liveScenario, requestOf(changes, ''))
    expect(scenario.aircraft.at(-1)).toEqual({ id: 'A06', at: 'East', type: 'cityairbus' })
    expect(scenario.vertiports.map((one) => one.stands)).toEqual([9, 3, 2])
  })

  it('is compared figure by figure', () => {
    const rows = compared(outlook, {
      ...outlook,
      totals: { ...outlook.totals, passengers: 1 },
      upper_bound_usd: null,
    })
    expect(rows.find((one) => one.name === 'passengers')).toMatchObject({ whatIf: 1, isGood: true })
    expect(rows.find((one) => one.name === 'bound')?.whatIf).toBeUndefined()
  })
})

it('the id of an additional aircraft is unused', () => {
  expect(freshId(['A01', 'A02'])).toBe('A03')
  expect(freshId(['A01', 'A03'])).toBe('A04')
  expect(freshId(['N7', 'A03', 'A04'])).toBe('A05')
})
