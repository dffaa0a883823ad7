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
  dispatched: 'dispatched, not departed',
  overdueBy: (minutes: number) => `overdue by ${minutes} min`,
  overdueOne: (aircraft: string, minutes: number) => `${aircraft} overdue by ${minutes} min`,
  late: (minutes: number) => `+${minutes} min`,
  due: {
    departure: (time: string) => `take-off was due at ${time}`,
    landing: (time: string) => `landing was due at ${time}`,
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
    demand: 'waiting passengers, strongest at their origin',
    closed: 'route closed',
  },
  miles: (number: string) => `${number} mi`,
  kilometres: (number: string) => `${number} km`,
  attribution: 'Natural Earth',
  failedBasemap: 'The base map could not be loaded; the bundled one is shown.',
  aircraftOfType: (id: string, type: string) => `${id}, aircraft of type “${type}”`,
  phases: {
    waiting: 'ready, waiting for a decision',
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
  chargesForFlight: 'charging for its flight',
  charge: (share: string) => `about ${share} charged`,
  chargeOf: (kwh: string, battery: string) => `about ${kwh} kWh of ${battery}`,
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
  noLegs: 'No flights.',
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
  charges: (begins: string, ends: string) => `from ${begins} to ${ends} kWh`,
  since: (begins: string) => `since ${begins}`,
  planned: (departs: string, arrives: string, ready: string) =>
    `planned ${departs} to ${arrives}, ready ${ready}`,
  ready: (time: string) => `ready ${time}`,
  passengers: (number: number, seats: number) => `${number} of ${seats} seats`,
  decidedBy: (policy: string) => `decided by ${policy}`,
  differs: (other: string, what: string, time: string, passengers: number | undefined) =>
    `differs from “${other}”: there ${what} since ${time}${passengers === undefined ? '' : ` with ${plural(passengers, 'passenger', 'passengers')}`}`,
  nothingThere: (other: string) => `differs from “${other}”: nothing there yet`,
  late: (minutes: number) => `+${minutes}`,
  stand: (stand: string) => `stand ${stand}`,
  over: 'no free stand',
}

export const replay = {
  title: 'Replay',
  day: 'Day',
  policy: 'Policy',
  withPolicy: 'Compare with',
  alone: 'nothing',
  choice: (policy: string, profit: string) => `${policy} · ${profit}`,
  transport: 'Play the day',
  play: 'Play',
  pause: 'Pause',
  next: 'Next decision',
  former: 'Previous decision',
  faster: 'Play faster',
  slower: 'Play slower',
  begin: 'Beginning of the day',
  finish: 'End of the day',
  speed: 'Speed, seconds of the day per second',
  times: (speed: number) => `${speed.toLocaleString('en-US')} ×`,
  link: 'Copy a link to this moment',
  linkShort: 'Link',
  linked: 'The link to this moment is copied.',
  linkAt: (address: string) => `A link to this moment: ${address}`,
  scrubber: 'Time of the day',
  legend: {
    profit: 'profit so far',
    difference: (one: string, other: string, now: string) =>
      `lead of “${one}” above the middle, of “${other}” below it; ${now}`,
    ahead: (time: string, who: string, dollars: string) => `“${who}” leads by ${dollars} at ${time}`,
    level: (time: string) => `neither leads at ${time}`,
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
      ? `Over the whole day ${plan}, would have earned ${difference} than the actual day.`
      : `By ${until} ${plan}, would have earned ${difference} than the actual day.`,
  dayPlanWhy: 'The day differed from the forecast, so this is not the effect of a single decision.',
  dayOther: (one: string, other: string, difference: string, until: string | undefined) =>
    `${until === undefined ? 'Over the whole day' : `By ${until}`} “${one}” has earned ${difference} than “${other}”.`,
  dayOtherWhy: 'They had different passengers and events, so this is not the effect of a single decision.',
  moreMoney: (dollars: string) => `${dollars} more`,
  lessMoney: (dollars: string) => `${dollars} less`,
  sameMoney: 'neither more nor less',
  same: (one: string, other: string) => `“${one}” and “${other}” send every aircraft on the same routes.`,
  goToDifference: 'To the first difference',
  explanation:
    'Drop a scenario file and one or more of its traces here, or choose them. This page reads them and sends nothing.',
  make: 'The program writes both:',
  choose: 'Choose files',
  add: 'Add files',
  addHint:
    'Adds other policies to this day from one or more of its traces (.csv), for comparison. A scenario file (.json) with its traces opens as another day. You can also drop files anywhere on this page. Nothing is sent.',
  addMake: 'The program writes the scenario and the traces:',
  addWrong:
    'If a file is invalid, or a trace belongs to another day, the page lists the problem of each file and keeps the current day.',
  fromFiles: 'From files:',
  backToDay: (day: string) => `Back to ${day}`,
  traceOf: (name: string) => `${name}, from a file`,
  unknownPolicy: (name: string) => `There is no policy “${name}” to compare with the day.`,
  asItWas: 'Actual day',
  planned: (policy: string) => `${policy}, as planned in the morning`,
  plannedExplanation: (policy: string) =>
    `The decisions of ${policy} if the day had gone as forecast in the morning.`,
  comparisonHint:
    'Compares the day with a policy’s decisions if the day had gone as forecast in the morning.',
  planning: (policy: string) => `Planning the day with ${policy}…`,
  daysOfService: 'Days of this service',
  inFile: (file: string, fault: string) => `${file}: ${fault}`,
  faults: {
    'no-json': 'It begins like a scenario file (.json), but is not valid JSON. Is it complete?',
    'no-scenario': (format: string | undefined) =>
      format === undefined
        ? 'It is not a scenario file: “format” or other required members are missing.'
        : `It is not a scenario file for replays: its “format” is “${format}”.`,
    'second-scenario': (first: string) =>
      `It is a second scenario file in addition to ${first}. A replay shows one day: choose one scenario and its traces.`,
    'scenario-missing':
      'The scenario file (.json) is missing. Choose it together with the traces of its day.',
    'no-trace': (begins: string) =>
      `It is neither a trace nor a scenario: ${begins === '' ? 'its first line is empty' : `it begins with “${begins}”`}, but a trace begins with “time,aircraft,”.`,
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
