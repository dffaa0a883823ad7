// The screen sizes for screenshots, and their comparison.

import { expect, type Locator, type Page } from '@playwright/test'

/** Anti-aliasing differs slightly between machines. */
const TOLERANCE = { maxDiffPixelRatio: 0.002 }

export const screens = {
  desk: { width: 1280, height: 800 },
  phone: { width: 390, height: 844 },
}

/**
 * Compares the page with the stored screenshots, in the light and the dark theme; content that
 * changes in each run is masked.
 */
export async function expectToLook(page: Page, name: string, mask: Locator[] = []): Promise<void> {
  for (const colorScheme of ['light', 'dark'] as const) {
    await page.emulateMedia({ colorScheme })
    await expect.soft(page).toHaveScreenshot(`${name}-${colorScheme}.png`, { ...TOLERANCE, mask })
  }
}

/**
 * Screenshots use a font that `scripts/console` installs, regardless of the machine's preferences.
 */
export function useOneFont(): void {
  const style = () => {
    const sheet = new CSSStyleSheet()
    sheet.replaceSync(":root { --sans: 'Liberation Sans' !important; --mono: 'Liberation Mono' !important }")
    document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet]
  }
  document.addEventListener('DOMContentLoaded', style)
}
