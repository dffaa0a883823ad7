// English texts of the map, the timelines and the replay. They are part of en.ts, in a separate
// file, because pictures need many words for screen readers.

import { plural } from './numbers'

/** The names of flights and stands in the keys of the map and the timelines. */
const states = {
  full: 'full flight',
  partial: 'flight with free seats',
  empty: 'flight without passengers',
  delayed: 'take-off delayed',
  overdue: 'overdue',
  holding: 'holding',
  charging: 'charging',
  out: 'out of service',
}

export const map = {
  title: 'Map',
  summary: (vertiports: string, aircraft: string) => `A map of ${vertiports} and ${aircraft}.`,
  vertiports: (number: number) => plural(number, 'vertiport', 'vertiports'),
  aircraft: (number: number) => plural(number, 'aircraft', 'aircraft'),
  inTheAir: (number: number) => `${number} in the air`,
  overdue: (number: number) => `${number} overdue`,
  overdueBy: (minutes: number) => `overdue by ${minutes} min`,
  overdueOne: (aircraft: string, minutes: number) => `${aircraft} overdue by ${minutes} min`,
  late: (minutes: number) => `+${minutes} min`,
  due: {
    departure: (time: string) => `was to take off at ${time}`,
    landing: (time: string) => `was to land at ${time}`,
  },
  closed: (number: number) =>
    number === 0 ? 'no route is closed' : `${plural(number, 'route', 'routes')} closed`,
  summaryAt: (time: string, parts: string) => `At ${time}: ${parts}.`,
  tools: 'Tools of the map',
  zoomIn: 'Zoom in',
  zoomOut: 'Zoom out',
  fit: 'Show all vertiports',
  demand: 'Waiting passengers',
  key: 'Key',
  keys: {
    ...states,
    waiting: 'waiting for a decision',
    promised: 'stand promised',
    free: 'stand free',
    demand: 'passengers waiting, strong where they are',
    closed: 'route closed',
  },
  miles: (number: string) => `${number} mi`,
  kilometres: (number: string) => `${number} km`,
  attribution: 'Natural Earth',
  failedBasemap: 'The base map could not be loaded; the bundled one is shown.',
  aircraftOfType: (id: string, type: string) => `${id}, aircraft of type “${type}”`,
  phases: {
    waiting: 'ready, waits for a decision',
    charging: states.charging,
    holding: states.holding,
    delayed: states.delayed,
    flying: 'in the air',
    out: states.out,
  },
  from: (from: string, to: string) => `${from} → ${to}`,
  at: (vertiport: string) => `at ${vertiport}`,
  seats: (passengers: number, seats: number) => `${passengers} of ${seats} seats`,
  empty: 'no passengers',
  charge: (share: string) => `about ${share} charged`,
  lands: (time: string) => `lands ${time}`,
  readyAt: (time: string) => `ready ${time}`,
  holdsUntil: (time: string) => `until ${time}`,
  takesOff: (time: string) => `takes off ${time}`,
  stands: (taken: number, promised: number, room: number) =>
    `${taken} standing, ${promised} promised, ${Math.max(0, room - taken - promised)} of ${room} free`,
  waitingFrom: (number: number) => `${number.toLocaleString('en-US')} want to leave`,
  waitingTo: (number: number) => `${number.toLocaleString('en-US')} want to come`,
  vertiportClosed: 'closed to flights',
}

export const timeline = {
  fleet: 'Timeline of the fleet',
  stands: 'Timeline of the stands',
  roledescription: 'timeline',
  keys: 'Arrow keys move along the flights of an aircraft and from one aircraft to the next; plus and minus zoom, 0 shows the whole day.',
  tools: 'Tools of the timeline',
  zoomIn: 'Zoom in',
  zoomOut: 'Zoom out',
  whole: 'Show the whole day',
  aroundNow: 'Show the hours around now',
  table: 'As a table',
  picture: 'As a picture',
  key: {
    title: 'What the colours mean',
    ...states,
    noStand: 'no stand is free',
    expected: 'expected',
  },
  nothing: 'Nothing is selected.',
  aircraft: 'Aircraft',
  noLegs: 'It has no flight.',
  columns: {
    what: 'What',
    begins: 'Begins',
    ends: 'Ends',
    ready: 'Ready',
    passengers: 'Passengers',
    profit: 'Profit',
  },
  flight: (from: string, to: string) => `${from} → ${to}`,
  hold: (at: string) => `holds at ${at}`,
  expected: 'expected',
  kinds: {
    flight: 'flight',
    charge: 'charges',
    hold: 'holds',
    delay: 'take-off delayed',
    outage: 'out of service',
    promised: 'stand promised',
    standing: 'stands',
  },
  times: (begins: string, ends: string) => `${begins} to ${ends}`,
  since: (begins: string) => `since ${begins}`,
  planned: (departs: string, arrives: string, ready: string) =>
    `planned ${departs} to ${arrives}, ready ${ready}`,
  ready: (time: string) => `ready ${time}`,
  passengers: (number: number, seats: number) => `${number} of ${seats} seats`,
  decidedBy: (policy: string) => `decided by ${policy}`,
  otherwise: (other: string, what: string, time: string, passengers: number | undefined) =>
    `differs from “${other}”: there ${what} since ${time}${passengers === undefined ? '' : ` with ${plural(passengers, 'passenger', 'passengers')}`}`,
  nothingThere: (other: string) => `differs from “${other}”: nothing there yet`,
  late: (minutes: number) => `+${minutes}`,
  stand: (stand: string) => `stand ${stand}`,
  over: 'no stand for it',
}

export const replay = {
  title: 'Replay',
  day: 'Day',
  policy: 'Policy',
  withPolicy: 'Beside it',
  alone: 'nothing',
  choice: (policy: string, profit: string) => `${policy} · ${profit}`,
  transport: 'Play the day',
  play: 'Play',
  pause: 'Pause',
  next: 'To the next decision',
  former: 'To the former decision',
  faster: 'Play faster',
  slower: 'Play slower',
  begin: 'To the beginning of the day',
  finish: 'To the end of the day',
  speed: 'Speed, seconds of the day in a second',
  times: (speed: number) => `${speed.toLocaleString('en-US')} ×`,
  link: 'Copy a link to this moment',
  linkShort: 'Link',
  linked: 'The link to this moment is copied.',
  linkAt: (address: string) => `A link to this moment: ${address}`,
  scrubber: 'Time of the day',
  legend: {
    profit: 'profit so far',
    difference: (one: string, other: string, now: string) =>
      `who is ahead: above the middle “${one}”, below it “${other}”; ${now}`,
    ahead: (time: string, who: string, dollars: string) => `at ${time} “${who}” by ${dollars}`,
    level: (time: string) => `at ${time} neither`,
    carried: 'passengers carried',
    wanted: 'passengers who want to fly',
  },
  profit: 'Profit',
  carried: 'Passengers',
  flights: 'Flights',
  timelines: 'Timelines',
  fleet: 'Fleet',
  stands: 'Stands',
  difference: 'Where they first differ',
  differAt: (time: string) => `First difference at ${time}`,
  decide: (aircraft: string) => `${aircraft}:`,
  nothing: 'no decision',
  passengers: (number: number) => plural(number, 'passenger', 'passengers'),
  worth: (atDecision: string, atEnd: string) => `${atDecision}; ${atEnd}.`,
  worthAtDecision: (who: string | undefined, dollars: string) =>
    who === undefined
      ? 'With this decision alone both earn the same'
      : `With this decision alone ${who} earns ${dollars} more`,
  worthAtEnd: (who: string | undefined, dollars: string) =>
    who === undefined
      ? 'by the end of the day, with all later decisions, both have earned the same'
      : `by the end of the day, with all later decisions, ${who} has earned ${dollars} more`,
  dayPlan: (plan: string, difference: string, until: string | undefined) =>
    until === undefined
      ? `Over the whole day ${plan}, would have earned ${difference} than the day earned.`
      : `By ${until} ${plan}, would have earned ${difference} than the day has earned.`,
  dayPlanWhy: 'The day was not as forecast; no one decision is worth this.',
  dayOther: (one: string, other: string, difference: string, until: string | undefined) =>
    `${until === undefined ? 'Over the whole day' : `By ${until}`} “${one}” has earned ${difference} than “${other}”.`,
  dayOtherWhy:
    'They were not played with the same passengers and events, so this is not the worth of a decision.',
  moreMoney: (dollars: string) => `${dollars} more`,
  lessMoney: (dollars: string) => `${dollars} less`,
  sameMoney: 'neither more nor less',
  same: (one: string, other: string) => `“${one}” and “${other}” send every aircraft the same ways.`,
  goToDifference: 'To the first difference',
  explanation:
    'Drop a scenario file and one or more traces of it here, or choose them. Nothing is sent anywhere: they are read by this page.',
  make: 'The program writes both:',
  choose: 'Choose files',
  add: 'Add files',
  addHint:
    'Shows other policies on this day, from files: one or more traces of it (.csv), which can then be chosen beside what is shown. A scenario file (.json) with traces of its own opens as another day. You can also drop files anywhere on this page. They are not sent anywhere.',
  addMake: 'The program writes the scenario and the traces:',
  addWrong:
    'If a file is something else, or a trace is of another day, the page says of each file what is wrong with it, and goes on showing what it shows.',
  fromFiles: 'From files:',
  backToDay: (day: string) => `Back to ${day}`,
  traceOf: (name: string) => `${name}, from a file`,
  unknownBeside: (name: string) => `There is no policy “${name}” to show beside the day.`,
  asItWas: 'As it was',
  planned: (policy: string) => `${policy}, as planned in the morning`,
  plannedExplanation: (policy: string) =>
    `What ${policy} would have done if the day had gone as it was forecast in the morning.`,
  besideHint:
    'Shows beside the day what a policy would have done if the day had gone as it was forecast in the morning.',
  planning: (policy: string) => `${policy} plans the day…`,
  daysOfService: 'Days of this service',
  inFile: (file: string, fault: string) => `${file}: ${fault}`,
  faults: {
    'no-json': 'It begins as a scenario file (.json) does, and cannot be read as JSON. Is it whole?',
    'no-scenario': (format: string | undefined) =>
      format === undefined
        ? 'It is no scenario file: it does not say that it is one, as “format”, or lacks what belongs to one.'
        : `It is no scenario file that can be replayed: its “format” is “${format}”.`,
    'second-scenario': (first: string) =>
      `It is a second scenario file beside ${first}. A replay shows one day: choose one scenario and its traces.`,
    'scenario-missing':
      'The scenario file (.json) is missing. Choose it together with the traces of its day.',
    'no-trace': (begins: string) =>
      `It is neither a trace nor a scenario: ${begins === '' ? 'its first line is empty' : `it begins with “${begins}”`}, and a trace begins with “time,aircraft,”.`,
    'trace-missing':
      'A trace (.csv) is missing. Choose it together with its scenario; simulate --trace writes one.',
    'missing-column': (column: string) => `The trace has no column “${column}”.`,
    columns: (line: number, found: number, wanted: number) =>
      `Line ${line} has ${plural(found, 'value', 'values')} instead of ${wanted}.`,
    'unknown-id': (line: number, kind: 'aircraft' | 'vertiport', value: string) =>
      `Line ${line}: the day has no ${kind} “${value}”. Is it the trace of another day?`,
    unreadable: (line: number, column: string, value: string) =>
      `Line ${line}: “${value}” cannot be read as ${column}.`,
    'out-of-order': (line: number) => `Line ${line} is earlier than the line before it.`,
  },
}
