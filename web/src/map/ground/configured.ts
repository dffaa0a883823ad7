// The base map that replaces the bundled one (`serve --basemap`). The service writes its address
// into the page.

export function configuredBasemap(): string | undefined {
  return document.querySelector<HTMLMetaElement>('meta[name="vertifleet-basemap"]')?.content
}
