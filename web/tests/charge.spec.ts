// A dispatcher on a day that charges as needed: a flight waits for its charge.

import { readFileSync } from 'node:fs'
import { resolve } from 'node:path'
import { clock, timeOf } from '../src/model/time'
import { Fleet } from './support/fleet'
import { expect, expectAccessibleInBoth, open, panel, test } from './support/test'

const paperQuick = readFileSync(resolve('../networks/paper-quick.toml'), 'utf8')

/** A morning of `paper-quick`, with a reserve, on which an aircraft waits for a decision. */
async function morning(url: string): Promise<Fleet> {
  const toml = paperQuick
    .replace('name = "paper-quick"', 'name = "reserve"')
    .replace(/^charge_kw = .*$/m, (line) => `${line}\nreserve_kwh = 10`)
  await new Fleet(url, '').ask('PUT', '/v1/networks/reserve', { toml })
  const fleet = await Fleet.onNewDay(url, { network: 'reserve', seed: 1, policy: 'greedy' })
  await fleet.playUntil('08:00:00')
  return fleet
}

test('a flight waits for its charge', async ({ page, program }) => {
  const fleet = await Fleet.onNewDay(program.url, { network: 'paper-quick', seed: 1, policy: 'greedy' })
  await fleet.playUntil('08:00:00')
  await open(page, program, fleet)
  const name = (await fleet.waiting())[0] ?? ''
  const queue = page.getByRole('region', { name: 'Needs a decision' })
  await queue.getByRole('button', { name: new RegExp(`^${name}`) }).click()
  await expect(panel(page).getByText(/^\d+ kWh of 110$/)).toBeVisible()
  const takeoff = panel(page)
    .getByRole('cell', { name: /^takes off at \d\d:\d\d, when it has the \d+ kWh it needs$/ })
    .first()
  await expect(takeoff).toBeVisible()

  // The flight of the first such choice is decided.
  const row = panel(page)
    .getByRole('row')
    .filter({ has: page.locator('.entry') })
  const to = await takeoff.locator('xpath=../preceding-sibling::tr[1]//button').innerText()
  await row.getByRole('button', { name: to, exact: true }).click()
  await page.keyboard.press('o')
  await panel(page).getByRole('textbox', { name: 'Reason' }).fill('its passengers wait')
  await page.keyboard.press('Enter')
  await expect(page.getByText(`${name} flies to ${to}.`)).toBeVisible()

  // It waits on the ground, and its charge is a bar.
  await page.getByText('Charge of the aircraft').click()
  const entry = page.getByRole('group').getByRole('button', { name: new RegExp(`^${name} `) })
  await expect(entry).toContainText(/\d+ kWh of 110/)
  await expect(entry).toContainText(/takes off \d\d:\d\d/)
  await expect(page.getByRole('button', { name: /lands with \d+ kWh$/ }).first()).toBeVisible()
  await expectAccessibleInBoth(page)
})

test('a late departure is late after its landing too', async ({ page, program }) => {
  const toml = paperQuick
    .replace('name = "paper-quick"', 'name = "low"')
    .replace(/^start_positions = .*$/m, (line) => `${line}\nstart_charge = [0.1, 0.2]`)
  await new Fleet(program.url, '').ask('PUT', '/v1/networks/low', { toml })
  const fleet = await Fleet.onNewDay(program.url, { network: 'low', seed: 1, policy: 'greedy' })
  for (const aircraft of await fleet.waiting()) await fleet.decide(aircraft)
  await open(page, program, fleet, 'timeline')
  const before = await fleet.state()
  const { id, flight } = before.aircraft.find((one) => one.phase === 'sent_off') ?? {}
  const takeoff = timeOf(flight?.takeoff ?? 0)
  expect(takeoff).toBeGreaterThan(timeOf(flight?.decided ?? 0))
  await fleet.report({ type: 'departed', aircraft: id ?? '', time: clock(takeoff + 600) })
  const { aircraft } = await fleet.state()
  const arrival = aircraft.find((one) => one.id === id)?.arrival ?? ''
  const outlook = page.waitForResponse(/\/outlook/)
  await fleet.report({ type: 'landed', aircraft: id ?? '', time: arrival })
  await outlook

  await page.getByRole('button', { name: 'As a table' }).first().click()
  await page.getByRole('combobox', { name: 'Aircraft' }).selectOption(id ?? '')
  await page.getByRole('button', { name: 'As a table' }).first().click()
  const announcement = page.locator('[aria-live=polite]').filter({ hasText: id ?? '' })
  await expect(async () => {
    await page.getByRole('application', { name: /Timeline of the fleet/ }).press('Home')
    await expect(announcement).toContainText(`planned ${clock(takeoff)} to`, { timeout: 1000 })
  }).toPass()
  await expect(announcement).toContainText(`${clock(takeoff + 600)} to ${arrival}`)
})

test('a reserve is part of what a flight needs, and a landing may have its charge', async ({
  page,
  program,
}) => {
  const fleet = await morning(program.url)
  await open(page, program, fleet)
  await expect(
    panel(page)
      .getByText(/it needs with its reserve$/)
      .first(),
  ).toBeVisible()
  const { aircraft } = await fleet.state()
  const flying = aircraft.find((one) => one.phase === 'in_the_air')?.id ?? ''
  await page.keyboard.press('e')
  const dialog = page.getByRole('dialog')
  await dialog.getByLabel('What happened').selectOption('landed')
  await dialog.getByLabel(/^Aircraft/).selectOption(flying)
  await dialog.getByLabel('Charge of its battery').fill('33.5')
  await dialog.getByRole('button', { name: 'Report' }).click()
  await expect(page.getByText(new RegExp(`^${flying} has landed.* with 33.5 kWh`))).toBeVisible()
  const { charge_kwh } = (await fleet.state()).aircraft.find((one) => one.id === flying) ?? {}
  expect(charge_kwh).toBe(33.5)
})

test('a day that charges to full shows no charge', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await expect(page.getByText('kWh')).toHaveCount(0)
  await expect(page.getByText('Charge of the aircraft')).toHaveCount(0)
  await page.keyboard.press('e')
  await page.getByRole('dialog').getByLabel('What happened').selectOption('landed')
  await expect(page.getByRole('dialog').getByLabel(/^Charge/)).toHaveCount(0)
})
