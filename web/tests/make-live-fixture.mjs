// Makes src/model/fixtures/live-day.json: what the real service answers about a small day on which most things happen once.
//
//     VERTIFLEET_PROGRAM=../target/release/vertifleet node tests/make-live-fixture.mjs

import { spawn } from 'node:child_process'
import { mkdtemp, rm, writeFile } from 'node:fs/promises'
import { tmpdir } from 'node:os'
import { join } from 'node:path'

const network = `
format = "vertifleet-network/1"
name = "small"
start_positions = "random"
[operations]
start = "06:00:00"
end = "09:00:00"
takeoff_s = 600
landing_s = 600
hold_s = 900
[[vertiports]]
id = "North"
x_mi = 10
y_mi = 30
stands = 3
busy = true
[[vertiports]]
id = "East"
x_mi = 30
y_mi = 12
stands = 3
busy = false
[[vertiports]]
id = "South"
x_mi = 8
y_mi = 2
stands = 2
busy = true
[[aircraft_types]]
id = "cityairbus"
seats = 4
speed_mph = 74.5
battery_kwh = 110
energy_kwh_per_mi = 2.2
charge_kw = 150
self_discharge_per_h = 0
[[fleet]]
type = "cityairbus"
count = 5
[tariffs]
passenger_cost_usd_per_mi = 0.64
fare_base = 2
fare_demand_weight = 0.5
energy_price_usd_per_kwh = 0.2
[uniform_demand]
periods = ["06:00:00", "07:00:00", "08:00:00"]
least = 4
most = 12
`

const folder = await mkdtemp(join(tmpdir(), 'vertifleet-fixture-'))
const program = process.env.VERTIFLEET_PROGRAM ?? '../target/checked/release/vertifleet'
const service = spawn(program, ['serve', '--listen', '127.0.0.1:0', '--data', folder])
let said = ''
const base = await new Promise((resolve) => {
  for (const output of [service.stdout, service.stderr]) {
    output.on('data', (bytes) => {
      said += String(bytes)
      const found = /http:\/\/127\.0\.0\.1:\d+/.exec(said)
      if (found) resolve(found[0])
    })
  }
})

async function ask(method, path, body) {
  const answer = await fetch(base + path, { method, body: body && JSON.stringify(body) })
  const text = await answer.text()
  if (!answer.ok) throw new Error(`${method} ${path}: ${text}`)
  return JSON.parse(text)
}

await ask('PUT', '/v1/networks/small', { toml: network })
const { id } = await ask('POST', '/v1/days', {
  network: 'small',
  seed: 3,
  policy: 'prices',
  aircraft: { A01: 'North', A02: 'North', A03: 'East', A04: 'East', A05: 'South' },
})
const day = `/v1/days/${id}`
const decide = (aircraft, more) => ask('POST', `${day}/decisions`, { aircraft, ...more })
const report = (...events) => ask('POST', `${day}/events`, events)

// As planned but for a late departure; a decision that a person took, one that was undone, one that is a hold.
await decide('A01', { to: 'East' })
await report({ type: 'departed', aircraft: 'A01', time: '06:00:00' })
await decide('A02', { to: 'South', reason: 'the crew lives there' })
await report({ type: 'delayed', aircraft: 'A02', time: '06:01:00', until: '06:10:00' })
await report({ type: 'departed', aircraft: 'A02', time: '06:11:30' })
await decide('A03')
await report({ type: 'undone', aircraft: 'A03', time: '06:12:00' })
await decide('A03', { to: 'East', reason: 'fog' })
await report({
  type: 'out_of_service',
  aircraft: 'A04',
  time: '06:13:00',
  until: '07:30:00',
  reason: 'bird strike',
})
await report({
  type: 'closed',
  routes: { vertiport: 'South' },
  time: '06:20:00',
  until: '08:00:00',
  reason: 'fog',
})
await report({ type: 'reopened', routes: { from: 'South', to: 'North' }, time: '06:30:00' })
await report({ type: 'landed', aircraft: 'A01', time: '06:45:00' })
await report({
  type: 'demand',
  time: '06:46:00',
  period: '06:00:00',
  pairs: [{ from: 'North', to: 'East', passengers: 5 }],
})
await report({ type: 'booked', period: '07:00:00', from: 'South', to: 'North', passengers: 9 })
await report({ type: 'closed', routes: { from: 'East', to: 'South' }, time: '06:47:00' })
await decide('A03', { to: 'North' })

const paths = { info: '', scenario: '/scenario', state: '/state', outlook: '/outlook', events: '/events' }
const answers = {}
for (const [name, path] of Object.entries(paths)) answers[name] = await ask('GET', day + path)
answers.info.created_ms = 0
for (const event of answers.events.events) event.at_ms = 0
await writeFile('src/model/fixtures/live-day.json', `${JSON.stringify(answers)}\n`)
service.kill()
await rm(folder, { recursive: true })
