// The keys of a view, from the console's own list of keys.

import type { Page } from '@playwright/test'
import { expect } from './test'

/** The keys that the list of keys shows; those pressed at the same time are one text. */
export async function allKeysOf(page: Page): Promise<string[][]> {
  await page.keyboard.press('?')
  const lists = page.getByRole('dialog', { name: 'Keys' }).locator('dd .keys')
  await expect(lists.first()).toBeVisible()
  const keys = await lists.evaluateAll((all) =>
    all.map((one) => [...one.querySelectorAll('kbd')].map((key) => key.textContent)),
  )
  await page.keyboard.press('Escape')
  await expect(page.getByRole('dialog')).toBeHidden()
  return keys
}
