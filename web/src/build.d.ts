/** Whether the page carries everything with it, as reports do, and so has no base map of the operator's own. */
declare const __EMBEDDED__: boolean
