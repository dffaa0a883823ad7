// A day of New York for screenshots: a morning with a closure and an aircraft out of service, on
// which an aircraft waits for a decision.

import type { Page } from '@playwright/test'
import { Fleet } from './fleet'
import type { Program } from './program'

export async function morning(program: Program): Promise<Fleet> {
  const fleet = await Fleet.onNewDay(program.url, {
    network: 'new-york',
    seed: 3,
    policy: 'prices',
    date: '2026-06-01',
  })
  await fleet.playUntil('06:40:00')
  await fleet.report(
    { type: 'closed', routes: { from: 'JFK', to: 'LGA' }, until: '09:00:00', reason: 'thunderstorm' },
    { type: 'out_of_service', aircraft: 'A07', until: '08:30:00', reason: 'a rotor is looked at' },
  )
  await fleet.playUntil('07:20:00')
  return fleet
}

/**
 * Shows a day whose clock stands still: the page's time is ten minutes later, so the latest event
 * is long ago.
 */
export async function standStill(page: Page): Promise<void> {
  await page.clock.setFixedTime(Date.now() + 600_000)
}
