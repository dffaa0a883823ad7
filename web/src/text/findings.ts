// Rewords the service's findings about a network for planners: entries of a list are counted from
// one and called by their kind.

import { text } from './text'

const COUNTED = /\b(vertiports|aircraft_types|fleet)\[(\d+)\](?=: )/g
const EMPTY = /(^|: )([a-z_]+) must be [^:]*, found ""$/

export function readableFinding(message: string): string {
  const { entries, isEmpty } = text.editor.check
  return message
    .replace(EMPTY, (_, before: string, member: string) => before + isEmpty(member))
    .replace(COUNTED, (_, list: keyof typeof entries, index: string) => entries[list](Number(index) + 1))
}
