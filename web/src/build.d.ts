/** Whether the page carries everything with it, as reports do, and so has no room for drawing by the graphics processor. */
declare const __EMBEDDED__: boolean
