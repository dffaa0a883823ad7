// Makes src/model/fixtures/live-day.json: the real service's answers about a small day that covers
// most events once.
//
//     npx playwright test --config playwright.figures.config.ts figures/liveDay.spec.ts

import { writeFileSync } from 'node:fs'
import type { EventList } from '../src/api/types'
import { Fleet, smallNetwork } from '../tests/support/fleet'
import { test } from '../tests/support/test'

const toml = smallNetwork
  .replace('end = "10:00:00"', 'end = "09:00:00"')
  .replace('count = 6', 'count = 5')
  .replace(', "09:00:00"]', ']')
  .replace('most = 30', 'most = 12')

test('a live day', async ({ program }) => {
  await new Fleet(program.url, '').ask('PUT', '/v1/networks/small', { toml })
  const fleet = await Fleet.onNewDay(program.url, {
    network: 'small',
    seed: 3,
    policy: 'prices',
    aircraft: { A01: 'North', A02: 'North', A03: 'East', A04: 'East', A05: 'South' },
  })

  // As planned except for one late departure, one decision by a user, one that was undone, and one
  // hold.
  await fleet.decide('A01', { to: 'East' })
  await fleet.report({ type: 'departed', aircraft: 'A01', time: '06:00:00' })
  await fleet.decide('A02', { to: 'South', reason: 'the crew lives there' })
  await fleet.report({ type: 'delayed', aircraft: 'A02', time: '06:01:00', until: '06:10:00' })
  await fleet.report({ type: 'departed', aircraft: 'A02', time: '06:11:30' })
  await fleet.decide('A03')
  await fleet.report({ type: 'undone', aircraft: 'A03', time: '06:12:00' })
  await fleet.decide('A03', { to: 'East', reason: 'fog' })
  const strike = { time: '06:13:00', until: '07:30:00', reason: 'bird strike' }
  await fleet.report({ type: 'out_of_service', aircraft: 'A04', ...strike })
  const fog = { time: '06:20:00', until: '08:00:00', reason: 'fog' }
  await fleet.report({ type: 'closed', routes: { vertiport: 'South' }, ...fog })
  await fleet.report({ type: 'reopened', routes: { from: 'South', to: 'North' }, time: '06:30:00' })
  await fleet.report({ type: 'landed', aircraft: 'A01', time: '06:45:00' })
  const pairs = [{ from: 'North', to: 'East', passengers: 5 }]
  await fleet.report({ type: 'demand', time: '06:46:00', period: '06:00:00', pairs })
  await fleet.report({ type: 'booked', period: '07:00:00', from: 'South', to: 'North', passengers: 9 })
  await fleet.report({ type: 'closed', routes: { from: 'East', to: 'South' }, time: '06:47:00' })
  await fleet.decide('A03', { to: 'North' })

  const read = (path: string) => fleet.ask('GET', `/v1/days/${fleet.day}${path}`)
  const events = (await read('/events')) as EventList
  const answers = {
    info: { ...((await read('')) as object), created_ms: 0 },
    scenario: await read('/scenario'),
    state: await read('/state'),
    outlook: await read('/outlook'),
    events: { ...events, events: events.events.map((event) => ({ ...event, at_ms: 0 })) },
  }
  writeFileSync('src/model/fixtures/live-day.json', `${JSON.stringify(answers)}\n`)
})
