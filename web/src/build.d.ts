/**
 * Whether the page embeds everything it needs, as reports do. Such a page has no custom base map.
 */
declare const __EMBEDDED__: boolean
