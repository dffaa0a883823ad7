// The screens on which the console is looked at, and how much a picture may differ from the one that is kept.

/** Edges of letters and lines differ a little from machine to machine. */
export const TOLERANCE = { maxDiffPixelRatio: 0.002 }

export const screens = {
  desk: { width: 1280, height: 800 },
  phone: { width: 390, height: 844 },
}
