// Studies against the real program: started, followed, read, saved and deleted.

import { readFile } from 'node:fs/promises'
import type { Page } from '@playwright/test'
import type { StudyInfo } from '../src/api/types'
import { Fleet, smallNetwork } from './support/fleet'
import { expectToLook, screens } from './support/screens'
import { expect, expectAccessibleInBoth, test } from './support/test'

/** Plays a study to its end. */
async function played(url: string): Promise<void> {
  const service = new Fleet(url, '')
  await service.ask('PUT', '/v1/networks/small', { toml: smallNetwork })
  const body = { network: 'small', policies: ['greedy', 'prices', 'random'], days: 20, bounds: true }
  const made = (await service.ask('POST', '/v1/studies', body)) as StudyInfo
  await expect
    .poll(async () => ((await service.ask('GET', `/v1/studies/${made.id}`)) as StudyInfo).state, {
      timeout: 60_000,
    })
    .toBe('finished')
}

async function open(page: Page, console: string): Promise<void> {
  await page.goto(`${console}/#/studies`)
  await expect(page.getByRole('heading', { level: 1, name: 'Studies' })).toBeVisible()
}

test('a study is started, followed and read', async ({ page, context, program }) => {
  await new Fleet(program.url, '').ask('PUT', '/v1/networks/small', { toml: smallNetwork })
  await open(page, program.console)
  await expect(page.getByText('There are no studies yet.')).toBeVisible()
  await page.keyboard.press('n')
  const dialog = page.getByRole('dialog')
  await dialog.getByRole('combobox', { name: 'Network' }).selectOption('small')
  await dialog.getByRole('checkbox', { name: 'gcaps-x' }).uncheck()
  await dialog.getByRole('checkbox', { name: 'prices' }).check()
  await dialog.getByRole('checkbox', { name: 'random' }).check()
  await dialog.getByRole('radio', { name: 'Compare the others with random' }).check()
  await dialog.getByRole('spinbutton', { name: /^Days/ }).fill('8')
  await dialog.getByRole('button', { name: 'Start study' }).click()

  await expect(page.getByText(/(greedy|prices) earns \$[\d,]+ a day over 8 days/)).toBeVisible()
  await expect(page.getByText(/a day compared with random \(95 % interval/)).toBeVisible()
  const rows = page.getByRole('table', { name: 'Result' }).getByRole('row')
  await expect(rows).toHaveCount(4)
  await expect(rows.nth(1)).toContainText('random')
  await expect(page.getByRole('img', { name: /^Profit a day: / })).toBeVisible()
  await expect(page.getByRole('img', { name: /minus that of random on each day/ })).toBeVisible()
  const command = 'vertifleet compare --network small.toml --policies random,prices,greedy --days 8 --seed 1'
  await expect(page.getByText(/^vertifleet compare/)).toContainText(command.slice(0, 45))

  await page.getByRole('link', { name: 'Replay', exact: true }).last().click()
  await expect(page.getByLabel('Day', { exact: true })).toHaveValue('small-1')
  await expect(page.getByRole('region', { name: 'Map' })).toHaveCount(2)
  await page.getByLabel('Policy', { exact: true }).selectOption('greedy')
  await page.getByLabel('Compare with').selectOption('random')
  await expect(page.getByText(/First difference at/)).toBeVisible()
  await page.goBack()

  const opened = context.waitForEvent('page')
  await page.getByRole('link', { name: 'Report' }).click()
  const report = await opened
  await expect(report.getByRole('heading', { level: 1 })).toHaveText(/3 policies on 8 unseen days/)
  await report.getByTitle('Replay').scrollIntoViewIfNeeded()
  const replay = report.frameLocator('iframe[title=Replay]')
  await expect(replay.getByLabel('Day', { exact: true })).toHaveValue('small-1')
  await expect(replay.getByRole('region', { name: 'Map' }).first()).toBeVisible()

  await page.getByRole('button', { name: 'Delete' }).click()
  await expect(page.getByText('There are no studies yet.')).toBeVisible()
})

test('a running study shows its progress and can be stopped', async ({ page, program }) => {
  await open(page, program.console)
  await page.keyboard.press('n')
  const dialog = page.getByRole('dialog')
  await dialog.getByRole('checkbox', { name: 'rolling' }).check()
  await dialog.getByRole('spinbutton', { name: /^Days/ }).fill('1000')
  await dialog.getByRole('button', { name: 'Start study' }).click()
  await expect(page.getByRole('progressbar', { name: 'Progress' })).toBeVisible()
  await expect(page.getByText(/about .* left/)).toBeVisible({ timeout: 45_000 })
  await expect(page.getByRole('table', { name: /^So far/ })).toContainText('greedy', { timeout: 45_000 })
  await page.getByRole('button', { name: 'Stop' }).click()
  await expect(page.getByText('There are no studies yet.')).toBeVisible()
})

test('an impossible study is refused with its code', async ({ page, program }) => {
  await open(page, program.console)
  await page.keyboard.press('n')
  const dialog = page.getByRole('dialog')
  await dialog.getByRole('checkbox', { name: 'mlp' }).check()
  await dialog.getByRole('button', { name: 'Start study' }).click()
  await expect(page.getByText('Error V307')).toBeVisible()
  await expect(dialog).toBeVisible()
})

test('with a token the report is saved as a file', async ({ page, program }) => {
  await played(program.url)
  await page.addInitScript(
    (token) => sessionStorage.setItem('vertifleet-token', token),
    program.token('read'),
  )
  // A service that was queried before the token existed accepts all requests for a moment longer.
  await expect.poll(async () => (await fetch(`${program.url}/v1/studies`)).status).toBe(401)
  await open(page, program.console)
  const download = page.waitForEvent('download')
  await page.getByRole('button', { name: 'Save the report' }).click()
  const file = await download
  expect(file.suggestedFilename()).toBe('small-report.html')
  expect(await readFile(await file.path(), 'utf8')).toContain('3 policies on 20 unseen days')
  await expect(page.getByRole('button', { name: 'New study' })).toBeDisabled()
})

test('axe finds no serious problem in the studies', async ({ page, program }) => {
  await open(page, program.console)
  await expectAccessibleInBoth(page)
  await played(program.url)
  await expect(page.getByText(/earns \$/)).toBeVisible()
  await expectAccessibleInBoth(page)
  await page.keyboard.press('n')
  await expect(page.getByRole('dialog')).toBeVisible()
  await expectAccessibleInBoth(page)
})

test('studies look like their screenshots', async ({ page, program }) => {
  await played(program.url)
  for (const screen of ['desk', 'phone'] as const) {
    await page.setViewportSize(screens[screen])
    await open(page, program.console)
    await expect(page.getByText(/earns \$/)).toBeVisible()
    const frame = page.getByRole('region', { name: 'Result' })
    expect(await frame.evaluate((element) => element.scrollWidth - element.clientWidth)).toBeLessThan(
      screen === 'phone' ? 1 : Infinity,
    )
    await expectToLook(page, `studies-${screen}`, [page.locator('time')])
  }
})
