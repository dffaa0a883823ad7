// The screens on which the console is looked at, and how it looks there.

import { expect, type Locator, type Page } from '@playwright/test'

/** Edges of letters and lines differ a little from machine to machine. */
const TOLERANCE = { maxDiffPixelRatio: 0.002 }

export const screens = {
  desk: { width: 1280, height: 800 },
  phone: { width: 390, height: 844 },
}

/** Compares the page with the pictures that are kept, in the light and in the dark; what changes from run to run is masked. */
export async function expectToLook(page: Page, name: string, mask: Locator[] = []): Promise<void> {
  for (const colorScheme of ['light', 'dark'] as const) {
    await page.emulateMedia({ colorScheme })
    await expect.soft(page).toHaveScreenshot(`${name}-${colorScheme}.png`, { ...TOLERANCE, mask })
  }
}
