// Without a report an event has not happened: an aircraft that should have departed or landed stays
// at its last reported place, and is overdue.

import type { Page } from '@playwright/test'
import { clockMinutes, timeOf } from '../src/model/time'
import type { Fleet } from './support/fleet'
import { expect, expectAccessible, open, test } from './support/test'

/** Sends A01 to East, reports its departure, and returns its landing time. */
async function sendOff(fleet: Fleet): Promise<number> {
  await fleet.decide('A01', { to: 'East', reason: 'a test' })
  await fleet.report({ type: 'departed', aircraft: 'A01', time: '06:00:00' })
  const { aircraft } = await fleet.state()
  return timeOf(aircraft.find(({ id }) => id === 'A01')?.arrival ?? '')
}

function vertiport(page: Page, name: string) {
  return page.getByRole('button', { name: new RegExp(`^${name} \\d standing`) })
}

/** Shows the legs of A01 as a table. */
async function showTable(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'As a table' }).first().click()
  await page.getByRole('combobox', { name: 'Aircraft' }).selectOption('A01')
}

/** The line of the table with the flight of A01. */
function flightInTable(page: Page) {
  return page.getByRole('row', { name: /→ East/ }).first()
}

test('an aircraft without a reported landing is in the air and overdue in every view', async ({
  page,
  program,
  fleet,
}) => {
  const due = await sendOff(fleet)
  expect(clockMinutes(due)).toBe('06:41')
  await open(page, program, fleet)
  const summary = page.getByText(/^A map of/)
  await expect(summary).toContainText('1 in the air, no route')
  await page.getByRole('tab', { name: 'Vertiports' }).click()
  await expect(vertiport(page, 'East')).toContainText(/1 on the way/)
  const standing = (await vertiport(page, 'East').textContent())?.match(/(\d) standing/)?.[1]

  await fleet.report({ type: 'clock', time: '07:05:00' })
  await expect(summary).toContainText('At 07:05: 1 in the air, A01 overdue by 23 min, no route')
  await expect(vertiport(page, 'East')).toContainText(`${standing} standing, 1 on the way`)
  await expect(vertiport(page, 'East')).toContainText('1 overdue')
  await page.keyboard.press('w')
  const alerts = page.getByRole('region', { name: 'Alerts' })
  await expect(alerts).toContainText('A01 was due to land at East at 06:41, but no landing is reported')
  await expectAccessible(page)
  await page.keyboard.press('Escape')
  await expect(alerts).toBeHidden()
  await page.getByRole('tab', { name: 'Fleet timeline' }).click()
  await showTable(page)
  await expect(flightInTable(page)).toContainText('overdue by 23 min')
  await expect(flightInTable(page).getByRole('cell').nth(1)).toHaveText('07:05:00')
  await expectAccessible(page)

  // The others wait for decisions. Once they are decided, the panel shows the selected aircraft.
  for (const aircraft of await fleet.waiting()) await fleet.decide(aircraft)
  await page.keyboard.press('Control+k')
  await page.getByRole('combobox', { name: /Find a command/ }).fill('a01')
  await page.keyboard.press('Enter')
  const side = page.getByRole('region', { name: 'Decision', exact: true })
  await expect(side).toContainText('in the air to East, landing was due at 06:41:40')
  await expect(side).toContainText('overdue by 23 min')
  await expect(page.getByText(/Ready next/)).not.toContainText('A01 now')

  await fleet.report({ type: 'landed', aircraft: 'A01', time: '07:06:00' })
  await expect(summary).not.toContainText('A01 overdue')
  await expect(flightInTable(page)).not.toContainText('overdue')
  await expect(flightInTable(page).getByRole('cell').nth(1)).toHaveText('07:06:00')
})

test('an aircraft without a reported departure stays at its vertiport', async ({ page, program, fleet }) => {
  await fleet.decide('A01', { to: 'East', reason: 'a test' })
  await open(page, program, fleet)
  const summary = page.getByText(/^A map of/)
  await expect(summary).toContainText('0 in the air')
  await fleet.report({ type: 'clock', time: '06:50:00' })
  await expect(summary).toContainText('At 06:50: 0 in the air, A01 overdue by 50 min')
  await showTable(page)
  await expect(flightInTable(page)).toContainText('overdue by 50 min')
  await expect(flightInTable(page).getByRole('cell').nth(0)).toHaveText('06:50:00')
})

test('the replay and a what-if of the day show it in the air too', async ({ page, program, fleet }) => {
  await sendOff(fleet)
  await fleet.report({ type: 'clock', time: '07:05:00' })
  await open(page, program, fleet, 'replay')
  await page.keyboard.press('End')
  await expect(page.getByText(/^A map of/)).toContainText('1 in the air, A01 overdue by 23 min')
  await open(page, program, fleet, 'what-if')
  await page.getByRole('button', { name: 'Compare', exact: true }).click()
  await showTable(page)
  await expect(flightInTable(page)).toContainText('overdue by 23 min')
})
