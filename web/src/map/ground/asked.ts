// The base map that the service was told to show in place of the bundled one (`serve --basemap`), which it names in the page.

export function askedBasemap(): string | undefined {
  return document.querySelector<HTMLMetaElement>('meta[name="vertifleet-basemap"]')?.content
}
