// English texts of live days: alerts and what-ifs.

import { plural } from './numbers'

export const alerts = {
  title: 'Alerts',
  none: 'No alerts',
  allAcknowledged: 'Every alert is acknowledged',
  show: 'Show the alerts',
  acknowledge: 'Acknowledge',
  acknowledgeAll: 'Acknowledge all',
  acknowledged: (actor: string) => (actor === '' ? 'acknowledged' : `acknowledged by ${actor}`),
  age: 'Time since it began',
  severities: { critical: 'Critical', warning: 'Warning', notice: 'Notice' },
  counts: {
    critical: (number: number) => plural(number, 'critical alert', 'critical alerts'),
    warning: (number: number) => plural(number, 'warning', 'warnings'),
    notice: (number: number) => plural(number, 'notice', 'notices'),
  },
  messages: {
    overdue: {
      departure: (aircraft: string, to: string, due: string) =>
        `${aircraft} was due to leave for ${to} at ${due}, but no departure is reported`,
      landing: (aircraft: string, to: string, due: string) =>
        `${aircraft} was due to land at ${to} at ${due}, but no landing is reported`,
    },
    over_full: (vertiport: string, taken: number, stands: number) =>
      `${vertiport} has ${taken} aircraft, standing or on the way, for ${plural(stands, 'stand', 'stands')}`,
    full: (vertiport: string, stands: number) =>
      `${vertiport} is full: ${stands === 1 ? 'its stand' : `each of its ${stands} stands`} is taken or promised`,
    closed: (what: string, until: string | undefined, underWay: readonly string[]) =>
      `${what} is closed ${until === undefined ? 'until further notice' : `until ${until}`}${
        underWay.length === 0 ? '' : `; on the way there: ${underWay.join(', ')}`
      }`,
    out_of_service: (aircraft: string, until: string | undefined) =>
      `${aircraft} is out of service ${until === undefined ? 'until further notice' : `until ${until}`}`,
    low_charge: (aircraft: string, to: string, percent: number) =>
      `${aircraft} lands at ${to} with ${percent} % of its battery`,
  },
}

export const whatIf = {
  explanation:
    'Combine changes and compare how the day would continue with and without them. Comparing does not change the day.',
  change: 'Change',
  changes: 'Changes',
  kinds: {
    closed: 'Closure',
    delayed: 'Delay',
    out_of_service: 'Aircraft out of service',
    aircraft: 'More aircraft',
    stands: 'Stands of a vertiport',
    booked: 'More passengers',
  },
  vertiport: 'Vertiport',
  from: 'From',
  to: 'To',
  allRoutes: 'all its routes',
  aircraft: 'Aircraft',
  numbers: { aircraft: 'Aircraft', stands: 'Stands', booked: 'Passengers' },
  until: 'Until',
  untilFurther: 'further notice',
  period: 'Want to fly at',
  free: (vertiport: string, stands: number) => `${vertiport} (${Math.max(0, stands)} free)`,
  wrongTime: 'Enter the time as hours and minutes, for example 12:30.',
  add: 'Add the change',
  remove: (change: string) => `Remove: ${change}`,
  noChanges: 'No changes yet. You can also compare another policy alone.',
  policy: 'Policy that would decide',
  compare: 'Compare',
  comparing: 'Comparing…',
  report: (events: number) => (events === 1 ? 'Report it' : `Report all ${events}`),
  reportHint:
    'Reports the events to the day as having happened. Changes of aircraft and stands cannot be reported.',
  reported: (events: number) => `${plural(events, 'event is', 'events are')} reported to the day.`,
  result: 'Comparison',
  empty: 'The comparison appears here.',
  old: (time: string) => `Compared as of ${time}; the day has advanced since.`,
  other: 'The changes differ from those compared.',
  again: 'Compare again',
  moreAircraft: (id: string, at: string) => `additional aircraft ${id}, at ${at} in the morning`,
  moreStands: (vertiport: string, stands: number) => `${vertiport} with ${plural(stands, 'stand', 'stands')}`,
  columns: { number: 'The whole day', asItIs: 'As it is', whatIf: 'What if', difference: 'Difference' },
  rows: {
    profit: 'Profit',
    bound: 'Upper bound',
    passengers: 'Passengers served',
    spilled: 'Passengers spilled',
    flights: 'Flights',
    repositioning: 'Empty flights',
    holds: 'Holds',
    energy: 'Energy, kWh',
    loadFactor: 'Load factor',
  },
  points: (difference: string) => `${difference} points`,
  differs: (time: string, one: string, other: string) =>
    `They first differ at ${time}: ${one}; what if: ${other}.`,
  same: 'The day continues in the same way with and without the changes.',
  nothing: 'nothing',
  holds: (aircraft: string, at: string, time: string) => `${aircraft} holds at ${at} at ${time}`,
  flies: (aircraft: string, to: string, time: string, passengers: number) =>
    `${aircraft} flies to ${to} at ${time} with ${plural(passengers, 'passenger', 'passengers')}`,
  showFirst: 'Show the first difference',
  impact: {
    title: (until: string) => `Affected until ${until}`,
    none: 'Nothing differs in the next two hours.',
    aircraft: (number: number) => `${plural(number, 'aircraft is', 'aircraft are')} sent elsewhere`,
    passengers: (number: number, difference: string) =>
      `${plural(number, 'passenger', 'passengers')} fly (${difference})`,
    places: 'Landings, by vertiport',
    flies: (to: string, time: string, passengers: number) =>
      `to ${to} at ${time} with ${plural(passengers, 'passenger', 'passengers')}`,
    holds: (at: string) => `holds at ${at}`,
    insteadOf: (other: string) => `instead of: ${other}`,
    more: (number: number) => `and ${number} more`,
  },
  elsewhere: (differing: number, all: number, time: string) =>
    `different: ${differing.toLocaleString('en-US')} of ${plural(all, 'flight or hold', 'flights and holds')} until ${time}`,
  alike: (differing: number) => `different time or passengers: ${differing.toLocaleString('en-US')}`,
}
