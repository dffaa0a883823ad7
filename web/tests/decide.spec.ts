// A dispatcher decides in the console: accepts, overrides, takes back.

import { dollars } from '../src/model/money'
import { expect, open, panel, test, waiting } from './support/test'

test('an acceptance is the decision of the policy', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(waiting(page)).toHaveCount(6)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.waitForTimeout(400)
  await page.keyboard.press('a')
  await expect(page.getByText(/^A01 (flies to|holds at) /)).toBeVisible()
  await expect(waiting(page)).toHaveCount(5)
  const [decided] = await fleet.events()
  expect(decided?.event).toMatchObject({ type: 'decided', aircraft: 'A01', policy: 'prices' })
})

test('a key that is pressed twice decides for one aircraft', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.waitForTimeout(400)
  await page.keyboard.press('Enter')
  await page.keyboard.press('Enter')
  await page.keyboard.press('Enter')
  await expect(panel(page).getByRole('heading', { name: /^A02/ })).toBeVisible()
  expect(await fleet.events()).toHaveLength(1)
})

test('a whole disturbed day is dispatched by accepting', async ({ page, program, fleet }) => {
  test.setTimeout(240_000)
  await open(page, program, fleet)
  const count = page.getByRole('region', { name: 'Needs a decision' }).locator('.count')
  const accept = panel(page).getByRole('button', { name: 'Accept' })
  let decisions = 0
  while (await fleet.goOn()) {
    if (decisions === 8)
      await fleet.report({ type: 'closed', routes: { vertiport: 'South' }, until: '08:30:00' })
    if (decisions === 12) await fleet.report({ type: 'out_of_service', aircraft: 'A03', until: '09:00:00' })
    const all = (await fleet.state()).aircraft.filter((one) => one.needs_decision).length
    for (let left = all; left > 0; left--) {
      await expect(count).toHaveText(String(left))
      await expect(accept).toBeEnabled()
      await page.waitForTimeout(400)
      await page.keyboard.press('a')
      await expect(count).not.toHaveText(String(left))
      decisions += 1
    }
  }
  const { totals } = await fleet.state()
  expect(totals.decisions).toBe(decisions)
  expect(totals.passengers).toBeGreaterThan(0)
  const events = await fleet.events()
  const decided = events.filter((one) => one.event.type === 'decided')
  expect(decided.every(({ event }) => event.type === 'decided' && event.policy === 'prices')).toBe(true)
  await expect(page.locator('.figures')).toContainText(dollars(totals.profit_usd))
})

test('another decision needs a reason, and the log keeps it', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  const advised = (await panel(page).locator('.choice').innerText()).split(' ').at(-1)
  await page.keyboard.press('o')
  await expect(panel(page).getByRole('combobox', { name: 'Destination' })).toBeFocused()
  await panel(page).getByRole('button', { name: 'Override', exact: true }).click()
  await expect(panel(page).getByText('Say why')).toBeVisible()
  expect(await fleet.events()).toHaveLength(0)
  await panel(page).getByRole('textbox', { name: 'Reason' }).fill('the crew lives there')
  const to = await panel(page).getByRole('combobox', { name: 'Destination' }).inputValue()
  expect(to).not.toBe(advised)
  await page.keyboard.press('Enter')
  await expect(page.getByText(new RegExp(`^A01 (flies to|holds at) ${to}`))).toBeVisible()
  const [decided] = await fleet.events()
  expect(decided?.event).toMatchObject({
    aircraft: 'A01',
    to,
    instead_of: advised,
    reason: 'the crew lives there',
  })
  await page.keyboard.press('Escape')
  await page.goto(`${program.console}/#/day/${fleet.day}/log?aircraft=A01`)
  await expect(page.getByRole('cell', { name: /“the crew lives there”/ })).toBeVisible()
})

test('a decision is taken back as long as the aircraft has not departed', async ({
  page,
  program,
  fleet,
}) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.waitForTimeout(400)
  await page.keyboard.press('a')
  await expect(panel(page).getByRole('heading', { name: /^A02/ })).toBeVisible()
  await page.keyboard.press('u')
  await expect(page.getByText('The decision of A01 is taken back.')).toBeVisible()
  expect((await fleet.events()).map((one) => one.event.type)).toEqual(['decided', 'undone'])

  await expect(page.getByRole('region', { name: 'Needs a decision' }).locator('.count')).toHaveText('6')
  await page.keyboard.press('k')
  await expect(panel(page).getByRole('heading', { name: /^A01/ })).toBeVisible()
  await page.waitForTimeout(400)
  await page.keyboard.press('a')
  const lately = page
    .getByRole('region', { name: 'Decided lately' })
    .getByRole('listitem')
    .filter({ hasText: 'A01' })
  await expect(lately.getByRole('button', { name: 'Undo' })).toBeVisible()
  await fleet.report({ type: 'departed', aircraft: 'A01' })
  await expect(lately.getByRole('button', { name: 'Undo' })).toBeHidden()
})

test('what is not possible is shown with its rule', async ({ page, program, fleet }) => {
  await fleet.report({ type: 'closed', routes: { vertiport: 'East' } })
  await open(page, program, fleet)
  const impossible = panel(page).getByRole('listitem').filter({ hasText: 'East' })
  await expect(impossible).toContainText('Closed')
  await expect(impossible.locator('.unseen')).toContainText('cannot fly to vertiport "East"')
})

test('nothing moves under the pointer', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  const choice = panel(page).locator('.choice')
  const advised = await choice.innerText()
  const to = advised.split(' ').at(-1) ?? ''
  const accept = panel(page).getByRole('button', { name: 'Accept' })
  await accept.hover()
  const before = await accept.boundingBox()
  await fleet.report({ type: 'closed', routes: { vertiport: to } })
  await expect(panel(page).getByText(/The day has moved on/)).toBeVisible()
  expect(await choice.innerText()).toBe(advised)
  expect(await accept.boundingBox()).toEqual(before)
  await expect(accept).toBeDisabled()
  await page.keyboard.press('r')
  await expect(choice).not.toHaveText(advised)
  await expect(panel(page).getByText(/The day has moved on/)).toBeHidden()
})
