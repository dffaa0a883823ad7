// The picture in the README: the report that `make demo` writes.

import { pathToFileURL } from 'node:url'
import { expect, test } from '@playwright/test'

test('report', async ({ page }) => {
  await page.setViewportSize({ width: 1180, height: 1690 })
  await page.goto(pathToFileURL('../out/report/report.html').href)
  await expect(page.getByRole('heading', { name: 'Results' })).toBeVisible()
  await page.screenshot({ path: '../docs/src/images/report.png' })
})
