// The end of a day: the console shows the result, and offers no action that would change the day.

import { count, dollars } from '../src/model/money'
import { expect, expectAccessible, open, test } from './support/test'

test('a day that is over shows its result, and none of its decisions can be undone', async ({
  page,
  program,
  fleet,
}) => {
  await open(page, program, fleet)
  const figures = page.getByLabel('The day in figures')
  await expect(figures).toContainText('Upper bound')
  await expect(figures).toContainText('of dispatched flights')
  await fleet.playToTheEnd()

  const over = page.getByRole('region', { name: 'The day is over' })
  await expect(over).toBeVisible()
  const { now, totals } = await fleet.state()
  await expect(over).toContainText(dollars(totals.profit_usd))
  await expect(over).toContainText(`Passengers ${count(totals.passengers)}`)
  await expect(over).toContainText(`Over since ${String(now)}`)
  await expect(figures).not.toContainText('Upper bound')
  await expect(page.getByText('No one is waiting')).toHaveCount(0)
  await expect(page.getByText('Ready next')).toHaveCount(0)
  await expect(page.getByRole('region', { name: 'Recent decisions' }).getByRole('listitem')).not.toHaveCount(
    0,
  )
  await expect(page.getByRole('button', { name: 'Undo' })).toHaveCount(0)
  await expectAccessible(page)

  const download = page.waitForEvent('download')
  await over.getByRole('button', { name: 'Save the trace' }).click()
  expect((await download).suggestedFilename()).toBe('small-2.csv')
  await over.getByRole('link', { name: 'Replay the day' }).click()
  await expect(page.getByRole('heading', { level: 1, name: 'Replay' })).toBeAttached()
})
