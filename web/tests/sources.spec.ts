// Places, counts and finished flights come from the service's state, trace and events. They are
// right without any outlook, and with one that is late; the plan is then shown as being computed.

import type { Page } from '@playwright/test'
import type { DayState, Outlook, TakenEvent } from '../src/api/types'
import { isInForce } from '../src/model/closures'
import { withoutCorrected } from '../src/model/corrected'
import { Counts } from '../src/model/counts'
import { liveRecord } from '../src/model/live'
import { Fleet as Motion, NONE } from '../src/model/motion'
import { isHold, type DayRecord } from '../src/model/record'
import { Reports } from '../src/model/reports'
import type { Scenario } from '../src/model/scenario'
import { clock, timeOf } from '../src/model/time'
import { recordOf } from '../src/model/traces'
import { Fleet } from './support/fleet'
import { expect, open, test } from './support/test'
import { anyEvent, randomFrom, step } from './support/turbulent'

const networks = ['new-york-quick', 'disrupted']
const STEPS = 81

/** The day as the console has it, with decided legs and an outlook of earlier moments. */
function shown(known: Known, outlook?: Outlook): DayRecord {
  const { scenario, state, events, trace } = known
  const reports = new Reports(scenario)
  for (const event of events) reports.take(event)
  return liveRecord({ scenario, reports, state, outlook, decided: recordOf(scenario, trace).legs })
}

interface Known {
  scenario: Scenario
  state: DayState
  events: TakenEvent[]
  trace: string
}

/** Each place, flight under way and count, as the pictures have them at the state's time. */
function pictured(record: DayRecord, state: DayState): unknown {
  const happened = { ...record, legs: record.legs.filter((leg) => !leg.is_expected) }
  const motion = new Motion(happened)
  const frame = motion.frame()
  motion.show(timeOf(state.now), frame)
  const id = (vertiport: number | undefined) => record.vertiports[vertiport ?? NONE]?.id
  const aircraft = state.aircraft.map((one, at) => {
    const leg = happened.legs[frame.legs[at] ?? NONE]
    const stands = id(frame.stands[at])
    return one.flight == null ? [one.id, stands] : [one.id, stands, id(leg?.from), id(leg?.to), leg?.decided]
  })
  const counts = new Counts(happened)
  counts.count(frame)
  const vertiports = state.vertiports.map((one, at) => {
    const { taken, promised } = counts.standsOf(at)
    return [one.id, taken, promised]
  })
  return { now: state.now, aircraft, vertiports }
}

/** The same as the state has them. */
function stated({ now, aircraft, vertiports }: DayState): unknown {
  const flying = (one: DayState['aircraft'][number]) =>
    one.flight == null
      ? [one.id, one.place]
      : [
          one.id,
          one.phase === 'sent_off' ? one.flight.from : undefined,
          ...[one.flight.from, one.place, timeOf(one.flight.decided)],
        ]
  const counted = vertiports.map(({ id }) => {
    const here = aircraft.filter(({ place }) => place === id)
    const promised = here.filter(({ flight }) => flight != null).length
    return [id, here.length - promised, promised]
  })
  return { now, aircraft: aircraft.map(flying), vertiports: counted }
}

/** Every flight, so that none is missing. A diverted one ends elsewhere. */
function flights(legs: DayRecord['legs']): string[] {
  const key = (leg: DayRecord['legs'][number]) => [leg.aircraft, leg.decided, leg.from, leg.arrives].join()
  return legs
    .filter((leg) => !isHold(leg))
    .map(key)
    .sort()
}

for (const network of networks) {
  test(`places and flights are right whatever the plan and the trace, on ${network}`, async ({ program }) => {
    const fleet = await Fleet.onNewDay(program.url, { network, seed: 4, policy: 'greedy' })
    const scenario = (await fleet.ask('GET', `/v1/days/${fleet.day}/scenario`)) as Scenario
    const traceNow = () => fleet.text(`/v1/days/${fleet.day}/trace.csv`)
    const random = randomFrom(7)
    let [outlook, former]: (Outlook | undefined)[] = []
    let trace = await traceNow()
    for (let steps = 0; steps < STEPS && (await step(fleet, random)); steps++) {
      // An outlook that is up to 60 events old, and a trace that is up to 20 events old.
      if (steps % 30 === 0) {
        former = outlook
        outlook = (await fleet.ask('GET', `/v1/days/${fleet.day}/outlook`)) as Outlook
      }
      const known = { scenario, trace, state: await fleet.state(), events: await fleet.events() }
      for (const plan of [undefined, former])
        expect(pictured(shown(known, plan), known.state)).toEqual(stated(known.state))
      if (steps % 20 === 0) trace = await traceNow()
      if (steps % 40 !== 0) continue
      const legs = shown(known, former).legs.filter((leg) => !leg.is_expected)
      expect(flights(legs)).toEqual(flights(recordOf(scenario, await traceNow()).legs))
    }
    expect((await fleet.state()).totals.flights).toBeGreaterThan(30)
  })
}

for (const network of [...networks, 'paper-quick'])
  test(`the console's day is the service's after each of any events, on ${network}`, async ({ program }) => {
    for (const seed of [1, 2, 3]) {
      const fleet = await Fleet.onNewDay(program.url, { network, seed, policy: 'greedy' })
      const scenario = (await fleet.ask('GET', `/v1/days/${fleet.day}/scenario`)) as Scenario
      const random = randomFrom(seed)
      let [older, taken] = ['', 0]
      for (let steps = 0; steps < 120; steps++) {
        const event = anyEvent(await fleet.state(), random)
        const isTaken = await fleet.report(event).then(
          () => true,
          () => false,
        )
        if (!isTaken) continue
        const [state, events] = [await fleet.state(), withoutCorrected(await fleet.events())]
        const trace = await fleet.text(`/v1/days/${fleet.day}/trace.csv`)
        if (taken++ % 8 === 0) older = trace
        const why = JSON.stringify(event)
        // A trace that is some events old, and none; a correction is followed by a new one.
        if (event.type === 'corrected') older = trace
        for (const known of [trace, older, trace.split('\n', 1).join()])
          expect(pictured(shown({ scenario, state, events, trace: known }), state), why).toEqual(
            stated(state),
          )
        expect(flights(shown({ scenario, state, events, trace }).legs), why).toEqual(
          flights(recordOf(scenario, trace).legs),
        )
        const reports = new Reports(scenario)
        for (const one of events) reports.take(one)
        expect(closedNow(reports, state), why).toEqual(
          state.vertiports
            .flatMap(({ id, closed }) => closed.map(({ to, until }) => `${id} ${to} ${until ?? ''}`))
            .sort(),
        )
        const outages = reports.outages.filter((one) => isInForce(one, timeOf(state.now)))
        const outOf = outages.map(({ aircraft, until }) => [
          aircraft,
          until === undefined ? null : clock(until),
        ])
        const expected = state.aircraft.flatMap(({ out_of_service, out_until }, at) =>
          out_of_service ? [[at, out_until ?? null]] : [],
        )
        expect(outOf.sort(), why).toEqual(expected.sort())
      }
      expect(taken).toBeGreaterThan(40)
    }
  })

/** The routes that are closed at the state's time, as the console folds the events. */
function closedNow(reports: Reports, { now, vertiports }: DayState): string[] {
  const id = (at: number) => vertiports[at]?.id ?? ''
  const inForce = reports.closures.filter((one) => isInForce(one, timeOf(now)))
  const routes = inForce.flatMap((one): [number, number, number | undefined][] => {
    if (!('vertiport' in one)) return [[one.from, one.to, one.until]]
    const others = vertiports.map((_, at) => at).filter((at) => at !== one.vertiport)
    return others.flatMap((at) => [
      [at, one.vertiport, one.until],
      [one.vertiport, at, one.until],
    ])
  })
  return routes
    .map(([from, to, until]) => `${id(from)} ${id(to)} ${until === undefined ? '' : clock(until)}`)
    .sort()
}

/** Answers outlooks late, or refuses them. */
async function withOutlooks(page: Page, how: 'refused' | 'late'): Promise<void> {
  await page.route(/\/outlook/, async (route) => {
    if (how === 'refused')
      return route.fulfill({ status: 408, json: { status: 408, title: 'took too long', code: 'V000' } })
    const answer = await route.fetch()
    await new Promise((resume) => setTimeout(resume, 20_000))
    return route.fulfill({ response: answer }).catch(() => undefined)
  })
}

/** The list of vertiports as displayed, and as it follows from the state. */
async function expectListAsInState(page: Page, fleet: Fleet): Promise<void> {
  await expect(async () => {
    const { vertiports, aircraft, totals } = await fleet.state()
    const wanted = vertiports.map(({ id }) => {
      const here = aircraft.filter(({ place }) => place === id)
      const promised = here.filter(({ flight }) => flight != null).length
      return `${id} ${here.length - promised} standing, ${promised} on the way`
    })
    const words = await page.locator('.count .unseen').allInnerTexts()
    expect(vertiports.map(({ id }, at) => `${id} ${words[at]?.replace(/, of .*/, '')}`)).toEqual(wanted)
    await expect(page.locator('.figures')).toContainText(String(totals.flights), { timeout: 100 })
    const flying = aircraft.filter(({ phase }) => phase === 'in_the_air').length
    await expect(page.getByText(/^A map of/)).toContainText(`${flying} in the air`, { timeout: 100 })
  }).toPass({ timeout: 15_000 })
}

for (const network of networks) {
  for (const how of ['refused', 'late'] as const) {
    test(`what is shown is the state while outlooks are ${how}, on ${network}`, async ({ page, program }) => {
      const fleet = await Fleet.onNewDay(program.url, { network, seed: 4, policy: 'greedy' })
      await page.setViewportSize({ width: 1700, height: 1000 })
      await withOutlooks(page, how)
      await open(page, program, fleet)
      await expect(page.getByText('computing plan')).toBeVisible()
      const random = randomFrom(11)
      for (let steps = 0; steps < 75; steps++) {
        await step(fleet, random)
        if (steps % 5 === 0) await expectListAsInState(page, fleet)
      }
      if (how === 'refused') await expect(page.getByText('computing plan')).toBeVisible()
    })
  }
}

test('the plan replaces the notice once it is there', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(page.locator('.figures')).toContainText('with prices')
  await expect(page.getByText('computing plan')).toHaveCount(0)
})

test('a correction is shown although the service is busy at first', async ({ page, program, fleet }) => {
  await fleet.decide('A01', { to: 'East' })
  await page.setViewportSize({ width: 1700, height: 1000 })
  await open(page, program, fleet)
  await expectListAsInState(page, fleet)
  let refused = 0
  await page.route(/\/state$/, (route) =>
    refused++ < 3
      ? route.fulfill({ status: 503, json: { status: 503, title: 'busy', code: 'V000' } })
      : route.fallback(),
  )
  await fleet.report({ type: 'corrected', event: 1 })
  await expectListAsInState(page, fleet)
  expect(refused).toBeGreaterThan(3)
})
