// A network file in the form that the editor displays: all valid values, in one shape. A file may
// be incomplete while a user edits it, so every value may be absent. The service decides whether it
// is a valid network.

import { parseTime } from '../time'
import type { Seconds } from '../record'

export interface VertiportDraft {
  id: string
  x_mi: number | undefined
  y_mi: number | undefined
  latitude: number | undefined
  longitude: number | undefined
  stands: number | undefined
  chargers: number | undefined
  busy: boolean
}

export interface TypeDraft {
  id: string
  /** All members that are numbers. */
  numbers: Readonly<Record<string, number | undefined>>
  /** Charging power by charge: pairs of a share of the battery and kW; empty without a curve. */
  curve: [share: number, kw: number][]
}

export interface FleetDraft {
  type: string
  count: number | undefined
}

/** Passengers per period at the three levels of Eq. 1. */
export interface Level {
  mean: number
  sd: number
}

export type DemandDraft =
  | { model: 'daily'; shares: number[]; passengers: number[][] }
  | { model: 'gravity'; shares: number[]; total: number; weights: number[] }
  | { model: 'hourly'; pairs: { from: string; to: string; passengers: number[] }[] }
  | { model: 'equation1'; morning: number; evening: number; peak: Level; busyPairs: Level; otherwise: Level }
  | { model: 'uniform'; least: number; most: number }

/** The member of the file that contains each demand model. */
export const demandMembers = {
  daily: 'daily_demand',
  gravity: 'daily_demand',
  hourly: 'hourly_demand',
  equation1: 'demand',
  uniform: 'uniform_demand',
} as const satisfies Record<DemandDraft['model'], string>

export interface Draft {
  name: string
  vertiports: VertiportDraft[]
  types: TypeDraft[]
  fleet: FleetDraft[]
  /** The starts of the demand periods that can be read. */
  periods: Seconds[]
  demand: DemandDraft | undefined
  /** Whether places are degrees: either all vertiports have them or none. */
  isGlobe: boolean
}

type Members = Readonly<Record<string, unknown>>

/** Reads the values of a file. */
export function draftOf(value: unknown): Draft {
  const all = members(value)
  const vertiports = list(all['vertiports']).map(vertiportOf)
  const table = demandTable(all)
  return {
    name: text(all['name']),
    vertiports,
    types: list(all['aircraft_types']).map(typeOf),
    fleet: list(all['fleet']).map((one) => ({ type: text(one['type']), count: number(one['count']) })),
    periods: listOf(table?.['periods'])
      .map((one) => (typeof one === 'string' ? parseTime(one) : undefined))
      .filter((one) => one !== undefined),
    demand: demandOf(all),
    isGlobe: vertiports.some(({ latitude }) => latitude !== undefined),
  }
}

/** A member of the values by its path; undefined if it is missing. */
export function member(value: unknown, path: readonly (string | number)[]): unknown {
  return path.reduce<unknown>((within, step) => {
    if (typeof step === 'number') return Array.isArray(within) ? (within as unknown[])[step] : undefined
    return members(within)[step]
  }, value)
}

function vertiportOf(one: Members): VertiportDraft {
  return {
    id: text(one['id']),
    x_mi: number(one['x_mi']),
    y_mi: number(one['y_mi']),
    latitude: number(one['latitude']),
    longitude: number(one['longitude']),
    stands: number(one['stands']),
    chargers: number(one['chargers']),
    busy: one['busy'] === true,
  }
}

function typeOf(one: Members): TypeDraft {
  const curve = listOf(one['charge_curve']).flatMap((point): [number, number][] => {
    const [share, kw] = listOf(point)
    return typeof share === 'number' && typeof kw === 'number' ? [[share, kw]] : []
  })
  return { id: text(one['id']), numbers: numbersOf(one), curve }
}

function demandTable(all: Members): Members | undefined {
  const name = ['daily_demand', 'hourly_demand', 'demand', 'uniform_demand'].find((one) => one in all)
  return name === undefined ? undefined : members(all[name])
}

function demandOf(all: Members): DemandDraft | undefined {
  const table = demandTable(all)
  if (table === undefined) return undefined
  if ('daily_demand' in all) return dailyOf(table)
  if ('hourly_demand' in all) return { model: 'hourly', pairs: list(table['pairs']).map(pairOf) }
  if ('demand' in all) return equation1Of(table)
  return { model: 'uniform', least: number(table['least']) ?? 0, most: number(table['most']) ?? 0 }
}

function dailyOf(table: Members): DemandDraft {
  const shares = numbers(table['shares_percent'])
  if (!('gravity' in table))
    return { model: 'daily', shares, passengers: listOf(table['passengers']).map(numbers) }
  const gravity = members(table['gravity'])
  return {
    model: 'gravity',
    shares,
    total: number(gravity['passengers']) ?? 0,
    weights: numbers(gravity['weights']),
  }
}

function pairOf(one: Members): { from: string; to: string; passengers: number[] } {
  return { from: text(one['from']), to: text(one['to']), passengers: numbers(one['passengers']) }
}

function equation1Of(table: Members): DemandDraft {
  const starts = listOf(table['periods'])
  const level = (name: string): Level => {
    const one = members(table[name])
    return { mean: number(one['mean']) ?? 0, sd: number(one['sd']) ?? 0 }
  }
  return {
    model: 'equation1',
    morning: starts.indexOf(table['morning_peak']),
    evening: starts.indexOf(table['evening_peak']),
    peak: level('peak'),
    busyPairs: level('busy_pairs'),
    otherwise: level('otherwise'),
  }
}

function members(value: unknown): Members {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Members) : {}
}

function listOf(value: unknown): unknown[] {
  return Array.isArray(value) ? (value as unknown[]) : []
}

function list(value: unknown): Members[] {
  return listOf(value).map(members)
}

function numbers(value: unknown): number[] {
  return listOf(value).map((one) => number(one) ?? 0)
}

function numbersOf(one: Members): Readonly<Record<string, number | undefined>> {
  return Object.fromEntries(Object.entries(one).map(([name, value]) => [name, number(value)]))
}

function number(value: unknown): number | undefined {
  return typeof value === 'number' && Number.isFinite(value) ? value : undefined
}

function text(value: unknown): string {
  return typeof value === 'string' ? value : ''
}
