// The service stops and comes back; two users work on one day; a token is requested.

import { expect, open, panel, test } from './support/test'

test('a lost connection recovers, and typed text is still there', async ({ page, program, fleet }) => {
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('o')
  const reason = panel(page).getByRole('textbox', { name: 'Reason' })
  await reason.fill('half a rea')
  await program.kill()
  await expect(page.getByText('Reconnecting', { exact: true })).toBeVisible()
  await expect(page.getByText('Connection lost', { exact: true })).toBeVisible({ timeout: 20_000 })
  await reason.press('End')
  await reason.pressSequentially('son')
  await program.run()
  await expect(page.getByText('Live', { exact: true })).toBeVisible({ timeout: 15_000 })
  await expect(reason).toHaveValue('half a reason')
  await reason.press('Enter')
  await expect(page.getByText(/^A01 (flies to|holds at) /)).toBeVisible()
  expect((await fleet.events())[0]?.event).toMatchObject({ aircraft: 'A01', reason: 'half a reason' })
})

test('events during a lost connection are shown afterwards', async ({ page, program, fleet }) => {
  await open(page, program, fleet, 'log')
  await program.kill()
  await expect(page.getByText('Reconnecting', { exact: true })).toBeVisible()
  await program.run()
  await fleet.decide('A01')
  await fleet.report({ type: 'closed', routes: { vertiport: 'South' }, reason: 'fog' })
  await expect(page.getByText('Live', { exact: true })).toBeVisible({ timeout: 15_000 })
  await expect(page.getByRole('cell', { name: /All routes of South are closed/ })).toBeVisible()
  await expect(page.getByRole('cell', { name: /^A01 is to go to/ })).toHaveCount(1)
})

test('a service that stops a stream gives the reason', async ({ page, program, fleet }) => {
  await open(page, program, fleet, 'log')
  await fleet.ask('POST', `/v1/days/${fleet.day}/archive`)
  await fleet.ask('DELETE', `/v1/days/${fleet.day}`)
  await program.kill()
  await program.run()
  await expect(page.getByRole('alert')).toContainText(
    /the service has stopped sending this day\. Its reason: /,
  )
})

test('two consoles on one day show each other’s decisions', async ({ page, context, program, fleet }) => {
  const other = await context.newPage()
  await open(page, program, fleet)
  await open(other, program, fleet)
  const [mine, theirs] = [panel(page), panel(other)]
  await expect(mine.getByRole('heading', { name: /^A01/ })).toBeVisible()
  await theirs.getByRole('button', { name: 'Accept' }).hover()
  await page.bringToFront()
  await expect(mine.getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('a')
  await expect(mine.getByRole('heading', { name: /^A02/ })).toBeVisible()
  // The other console's pointer is on the decision that is gone: the panel shows this and does not
  // move.
  await expect(theirs.getByText(/^A01 was sent to/)).toBeVisible()
  await expect(theirs.getByRole('button', { name: 'Accept' })).toBeDisabled()
  await theirs.getByRole('button', { name: 'Next' }).click()
  await expect(theirs.getByRole('heading', { name: /^A02/ })).toBeVisible()
})

test('an idle console follows the other one', async ({ page, context, program, fleet }) => {
  const other = await context.newPage()
  await open(other, program, fleet)
  await open(page, program, fleet)
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.keyboard.press('a')
  await expect(panel(other).getByRole('heading', { name: /^A02/ })).toBeVisible()
})

test('a token is requested, kept out of addresses, and limits the actions', async ({
  page,
  program,
  fleet,
}) => {
  const [looks, dispatches] = [program.token('read'), program.token('dispatch')]
  await page.goto(`${program.console}/#/day/${fleet.day}/now`)
  const field = page.getByRole('textbox', { name: 'Token' }).or(page.locator('input[type=password]'))
  await field.fill('vf_wrong')
  await page.getByRole('button', { name: 'Sign in' }).click()
  await expect(page.getByText('The token is invalid or revoked')).toBeVisible()
  await field.fill(looks)
  await page.getByRole('button', { name: 'Sign in' }).click()
  await expect(page.getByText('You may view this day')).toBeVisible()
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeHidden()
  expect(page.url()).not.toContain('vf_')

  await page.keyboard.press('Control+k')
  await page.getByRole('combobox', { name: /Find a command/ }).fill('sign out')
  await page.keyboard.press('Enter')
  await field.fill(dispatches)
  await page.getByRole('button', { name: 'Sign in' }).click()
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
  await page.reload()
  await expect(panel(page).getByRole('button', { name: 'Accept' })).toBeEnabled()
})
