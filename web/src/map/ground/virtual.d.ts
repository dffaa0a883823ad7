// The module that basemap/plugin.ts makes when the console is built.
declare module 'virtual:basemap' {
  /** The address of each sector, by its name. A sector without an address is open sea. */
  export const addresses: Readonly<Record<string, string | undefined>>
}
