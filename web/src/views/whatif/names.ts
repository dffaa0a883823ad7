// The texts of changes.

import type { Change } from '../../model/whatif'
import { sentence } from '../../text/events'
import { text } from '../../text/text'

export function nameOf(change: Change): string {
  switch (change.kind) {
    case 'event':
      return sentence(change.event)
    case 'aircraft':
      return text.whatIf.moreAircraft(change.aircraft.id, change.aircraft.at)
    case 'stands':
      return text.whatIf.moreStands(change.vertiport, change.stands)
  }
}
