// The input of the map's painters, with sizes and colours.

import { StandState } from '../../model/counts'
import type { ColourName } from '../../parts/colours'
import { vertiportMeant, type Target } from '../../model/target'
import type { MapView, Size } from '../camera'
import type { Scene } from '../scene'

export interface Picture extends MapView {
  scene: Scene
  hovered: Target | undefined
  selected: Target | undefined
  /** The aircraft that the map keeps in its middle. */
  followed: number | undefined
  showsDemand: boolean
}

/** The inputs of rings, arcs, closures and names: everything except the moving aircraft. */
export function stillParts(picture: Picture): unknown[] {
  const { scene, camera, size, colours, hovered, selected, showsDemand } = picture
  const marked = [vertiportMeant(hovered), vertiportMeant(selected)]
  return [scene, scene.revision, camera, size, colours, showsDemand, ...marked]
}

export const COLOUR_OF_STATE: Record<StandState, ColourName> = {
  [StandState.waiting]: 'waiting',
  [StandState.holding]: 'holding',
  [StandState.charging]: 'charging',
  [StandState.out]: 'out',
  [StandState.promised]: 'flying',
  [StandState.free]: 'line-strong',
  [StandState.over]: 'bad',
}

/** Pieces for promised stands, and for free ones, are drawn lighter. */
export const OPACITY_OF_STATE: Record<StandState, number> = {
  [StandState.waiting]: 1,
  [StandState.holding]: 1,
  [StandState.charging]: 1,
  [StandState.out]: 1,
  [StandState.promised]: 0.55,
  [StandState.free]: 0.28,
  [StandState.over]: 1,
}

/** Half the length of an aircraft in the air, pixels; on the ground it is smaller. */
const AIRCRAFT_PX = { least: 6, most: 10 }
const SMALLEST = 0.68
/** With more aircraft in the air than this, they are drawn smaller. */
const MOST_FULL_SIZE = 40

/**
 * The size of aircraft and the opacity of their routes: less on a small picture, and less with many
 * flights.
 */
export function looksOf({ scene, size }: Picture): { aircraft_px: number; wayOpacity: number } {
  const crowd = Math.sqrt(Math.min(1, MOST_FULL_SIZE / Math.max(1, scene.counts.inTheAir)))
  const wanted = (3 + Math.min(size.width, size.height) / 110) * (0.6 + 0.4 * crowd)
  return {
    aircraft_px: Math.max(AIRCRAFT_PX.least, Math.min(AIRCRAFT_PX.most, wanted)),
    wayOpacity: 0.1 + 0.25 * crowd,
  }
}

export function aircraftSize(px: number, lift: number): number {
  return px * (SMALLEST + (1 - SMALLEST) * lift)
}

/**
 * The opacity of an aircraft: it fades where it takes off or lands, so that the ring of the
 * vertiport stays legible.
 */
export function visibilityNear(distance_px: number, radius: number): number {
  return Math.max(0, Math.min(1, (distance_px - 0.55 * radius) / (0.7 * radius)))
}

/** An aircraft from above that points up, in a square from -1 to 1. */
export const AIRCRAFT_SHAPE =
  'M0-1C.16-.86.17-.6.17-.38L.98.1V.32L.17.16.12.62.42.82V.98L0 .86-.42.98V.82L-.12.62-.17.16-.98.32V.1L-.17-.38C-.17-.6-.16-.86 0-1Z'

/** How strongly an aircraft is filled: 0 for a flight without passengers. */
export function fillOf(load: number): number {
  return load === 0 ? 0 : 0.35 + 0.65 * load
}

/**
 * The stroke width of an arc of waiting passengers. The arc's area, not its width, is proportional
 * to their number. Small maps have thin arcs.
 */
export function arcWidth(passengers: number, { width, height }: Size): number {
  const room = Math.min(1, Math.min(width, height) / 700)
  return Math.min(5, 0.4 + 0.45 * Math.sqrt(passengers)) * (0.4 + 0.6 * room)
}

/**
 * The distance of an arc from the straight route, as a share of its length. The opposite direction
 * bends to the other side.
 */
export const ARC_BEND = 0.16
