// All English texts of the console, ordered by where they appear. A text with parameters is a
// function.

import { alerts, whatIf } from './en.live'
import { map, replay, timeline } from './en.pictures'
import { editor, studies } from './en.planning'
import { plural } from './numbers'

export const en = {
  language: 'en',

  shell: {
    title: 'Vertifleet',
    skip: 'Skip to the content',
    views: 'Views',
    palette: 'Find a command',
    paletteHint: 'Find a command, an aircraft or a vertiport',
    paletteEmpty: 'No matches.',
    help: 'Keys',
    helpSingleKeys:
      'Single keys run commands. Switch them off if you use voice input or press keys by accident.',
    licences: 'Licences of third-party software',
    close: 'Close',
    cancel: 'Cancel',
    theme: 'Appearance',
    themes: { system: 'System', light: 'Light', dark: 'Dark' },
    loading: 'Loading…',
    unknownAddress: (view: string) => `There is no page at this address. Showing “${view}” instead.`,
    failedToLoad: 'This part of the console could not be loaded.',
    tryAgain: 'Try again',
    groups: { go: 'Go to', select: 'Select', console: 'Console', decide: 'Decide', day: 'Day', view: 'View' },
  },

  views: {
    days: 'Days',
    now: 'Now',
    timeline: 'Timeline',
    'what-if': 'What if',
    log: 'Log',
    replay: 'Replay',
    networks: 'Networks',
    studies: 'Studies',
  },

  connection: {
    connecting: 'Connecting',
    connected: 'Live',
    silent: (duration: string) => `Silent for ${duration}`,
    isSilent: 'The service is silent',
    silentHint: 'The service normally sends a heartbeat every two seconds. The display may be out of date.',
    healing: 'Reconnecting',
    lost: 'Connection lost',
    lostHint:
      'The display may be out of date. Updates resume when the service is back, and your input is kept.',
    refused: (why: string) =>
      `The display is out of date, because the service has stopped sending this day. Its reason: ${why}`,
  },

  errors: {
    noAnswer: 'The service does not answer.',
    noAnswerHint: 'Every change that took effect is displayed. Try again when the connection is back.',
    notPermittedHint: 'Your token does not permit this.',
    code: (code: string) => `Error ${code}`,
    dismiss: 'Dismiss',
    notFound: {
      day: (id: string) => ({
        title: `There is no day “${id}” here.`,
        hint: 'It may have been deleted, or the link belongs to another service.',
      }),
      study: (id: string) => ({
        title: `There is no study “${id}” here.`,
        hint: 'It may have been deleted. A restart of the service also deletes studies.',
      }),
      network: (id: string) => ({
        title: `There is no network “${id}” here.`,
        hint: 'It may have been deleted, or the link belongs to another service.',
      }),
      policy: (id: string) => ({
        title: `There is no policy “${id}”.`,
        hint: 'Choose one from the list.',
      }),
    },
    lists: { days: 'All days', studies: 'All studies', networks: 'All networks', replay: 'Replays' },
  },

  session: {
    title: 'Sign in',
    explanation: 'The service requires a token. It is kept until you close this tab.',
    token: 'Token',
    make: 'An administrator can create one with:',
    signIn: 'Sign in',
    signOut: 'Sign out',
    refused: 'The token is invalid or revoked.',
  },

  days: {
    title: 'Days',
    none: 'There are no days yet.',
    noneHint: 'Create one from a network, or run one with the simulated operator:',
    make: 'New day',
    columns: {
      name: 'Day',
      state: 'State',
      waiting: 'Needs a decision',
      profit: 'Profit so far',
      date: 'Date',
      policy: 'Policy',
      made: 'Created',
    },
    states: { running: 'Running', over: 'Over', archived: 'Archived' },
    waitingUnit: ' aircraft',
    noneWaits: 'none',
    madeHint: (zone: string) => `In this computer’s time zone, ${zone}`,
    network: 'Network',
    seed: 'Seed',
    seedHint: 'Determines the forecast and the initial positions of the aircraft.',
    policy: 'Policy',
    policyDefault: (policy: string) => `Default (${policy})`,
    date: 'Date',
    dateHint: 'Without a date, the day has a clock but no calendar.',
    name: 'Name',
    optional: 'optional',
    create: 'Create day',
    made: (name: string) => `Day ${name} has been created.`,
    networkSize: (vertiports: number, aircraft: number) =>
      `${plural(vertiports, 'vertiport', 'vertiports')}, ${plural(aircraft, 'aircraft', 'aircraft')}`,
  },

  day: {
    unreadable: 'This day cannot be shown.',
    backToDays: 'All days',
    archived: 'Archived: this day can no longer change.',
    timeZone: (zone: string) => `Times are in ${zone}.`,
    aircraft: (id: string) => `Aircraft ${id}`,
    vertiport: (id: string) => `Vertiport ${id}`,
    ownClock: 'the day’s own clock',
    clockOnly: 'The day has no date: times are on its own clock.',
  },

  now: {
    figures: 'The day in figures',
    profit: 'Profit so far',
    sentOff: 'of dispatched flights',
    sentOffHint:
      'A flight counts from its decision on, before it departs. If the decision is undone, it no longer counts.',
    expected: 'Expected',
    expectedBy: (policy: string) => `with ${policy}`,
    planning: 'plan is being computed…',
    expectedHint: (policy: string) => `The profit of the day if ${policy} takes every decision from now on.`,
    bound: 'Upper bound',
    boundHint:
      'A proven upper bound on the profit of the whole day, over all decisions that are still open. It uses the information known now, and excludes profit that earlier decisions missed.',
    noBound: 'The rest of the day is too large for a quick bound.',
    shareOfBound: (share: string) => `${share} expected`,
    passengers: 'Passengers',
    flights: 'Flights',
    repositioning: (number: number) =>
      number === 0 ? 'none empty' : `${number.toLocaleString('en-US')} empty`,
    loadFactor: (share: string) => `${share} of seats taken`,
    speed:
      'The approximate speed of the day, relative to real time. Between two events the clock runs on at this speed, for at most two minutes of the day.',
    still: 'stands still',
    stillAwaited: 'This simulated day continues when the waiting aircraft have been decided.',
    stillHint: 'No new events. The clock shows the time of the latest one.',
    times: (speed: number) => `×${speed}`,
    map: 'Map',
    fleet: 'Fleet timeline',
    side: 'Decisions',
  },

  over: {
    title: 'The day is over',
    state: 'over',
    profit: 'Profit of the day',
    since: 'Over since',
    explanation: 'Every aircraft is on the ground, and no decisions are left.',
    replay: 'Replay the day',
  },

  queue: {
    title: 'Needs a decision',
    none: 'No one is waiting.',
    next: 'Ready next',
    ready: (time: string) => `ready ${time}`,
    waits: (duration: string) => `waits ${duration}`,
    in: (duration: string) => `in ${duration}`,
    now: 'now',
    full: 'every stand is taken',
    decided: 'decided',
    nextCommand: 'Next waiting aircraft',
    formerCommand: 'Previous waiting aircraft',
  },

  decision: {
    title: 'Decision',
    none: 'No aircraft is waiting for a decision. The next one appears here.',
    asking: (aircraft: string) => `Getting advice for ${aircraft}…`,
    at: (vertiport: string) => `at ${vertiport}`,
    readySince: (time: string) => `ready since ${time}`,
    flyTo: 'Fly to',
    hold: 'Hold at',
    accept: 'Accept',
    sending: 'Sending…',
    unanswered: 'Sent; the service has not answered yet.',
    override: 'Override…',
    overrideCommand: 'Override the recommendation',
    by: (policy: string) => `${policy} recommends this`,
    tooLate: (asked: string, policy: string) => `${asked} was not ready in time; ${policy} answered instead.`,
    policy: 'Advising policy',
    dayPolicy: (policy: string) => `${policy} (the day’s)`,
    newer: (to: string) => `The day has advanced. New advice: ${to}.`,
    newerSame: 'The day has advanced, and the alternatives have changed.',
    showNewer: 'Show',
    showNewerCommand: 'Show the new advice',
    gone: (aircraft: string) => `${aircraft} no longer waits.`,
    goneDecided: (aircraft: string, to: string, who: string) => `${aircraft} was sent to ${to} (${who}).`,
    goOn: 'Next',
    passengers: (number: number) => `${number} ${number === 1 ? 'passenger' : 'passengers'}`,
    takesOff: (time: string) => `takes off ${time}`,
    takesOffCharged: (time: string, needs: string, hasReserve: boolean) =>
      `takes off at ${time}, when it has the ${needs} kWh it needs${hasReserve ? ' with its reserve' : ''}`,
    lands: (time: string) => `lands ${time}`,
    readyAgain: (time: string) => `ready ${time}`,
    alternatives: 'Alternatives',
    columns: {
      to: 'To',
      numbers: { worth: 'Worth, $', dollars_per_hour: 'Value, $/h', none: 'Score' },
      profit: 'Profit',
      passengers: 'Pass.',
      arrival: 'Lands',
      stands: 'Stands',
    },
    columnHints: {
      numbers: {
        worth: 'The worth of the choice until the end of the day, at the day’s bid prices, in dollars.',
        dollars_per_hour:
          'The value by which the policy compares choices: the profit of the flight, in dollars per hour.',
        none: 'The score by which the policy compares choices. It has no unit, and higher is better.',
      },
      profit: 'The profit of the flight alone.',
      stands: 'Stands taken or promised, out of all stands.',
    },
    notConsidered: 'not considered',
    holdHere: 'hold',
    impossible: 'Not possible',
    ruleReasons: {
      out_of_range: (to: string) => `A full battery does not last for the flight to ${to} and the reserve.`,
      no_corridor: (to: string) => `No corridor leads from here to ${to}.`,
      closed: (to: string) => `The route to ${to} is closed.`,
      no_stand_free: (to: string, numbers: string) =>
        `Every stand or charger at ${to} is taken, or reserved for an aircraft on its way there${numbers}.`,
      charged_too_late: (to: string) =>
        `The battery has the energy of the flight to ${to} and the reserve only after the end of operations.`,
    },
    why: 'Worth in detail',
    worthParts: {
      flight: 'Profit of the flight',
      onward: 'Value of its later flights',
      stand: 'Price of its stand',
      sum: 'Worth',
      corrected: (policy: string) => `Adjusted by ${policy}`,
    },
    reason: 'Reason',
    reasonHint: (to: string) => `Why ${to}? The reason is logged.`,
    reasonMissing: 'Enter a reason for the log.',
    destination: 'Destination',
    send: 'Override',
    taken: (aircraft: string, to: string) => `${aircraft} flies to ${to}.`,
    takenHold: (aircraft: string, at: string) => `${aircraft} holds at ${at}.`,
    undo: 'Undo',
    undoCommand: 'Undo your latest decision here',
    undone: (aircraft: string) => `The decision of ${aircraft} has been undone.`,
    changed: 'The day has advanced, and the policy now chooses differently. Nothing was decided.',
    mayNotDecide: 'You may view this day, but not decide on it.',
  },

  expected: {
    title: 'Expected next',
    planning: 'The plan for the rest of the day is being computed.',
    by: (policy: string) => `if ${policy} decides`,
    hold: (at: string) => `holds at ${at}`,
    route: (from: string, to: string) => `${from} → ${to}`,
  },

  decided: {
    title: 'Recent decisions',
    none: 'No decisions yet.',
    hold: 'hold',
    you: 'you',
    person: 'a person',
    asAdvised: (policy: string) => `as ${policy} advised`,
    noNameHint: 'Without tokens the service cannot identify who accepted the advice: a person or a program.',
    insteadOf: (to: string) => `instead of ${to}`,
  },

  vertiports: {
    title: 'Vertiports',
    stands: (standing: number, promised: number, stands: number) =>
      `${standing} standing, ${promised} on the way, of ${stands} stands`,
    closed: (routes: number) => (routes === 1 ? '1 route closed' : `${routes} routes closed`),
    allClosed: 'closed',
    standing: 'standing',
    promised: 'on the way',
    free: 'free',
  },

  alerts,

  report: {
    title: 'Report an event',
    open: 'Report…',
    what: 'What happened',
    kinds: {
      departed: 'An aircraft has departed',
      landed: 'An aircraft has landed',
      ready: 'An aircraft is ready',
      delayed: 'An aircraft is delayed',
      out_of_service: 'An aircraft is out of service',
      back_in_service: 'An aircraft is back in service',
      closed: 'A vertiport or routes are closed',
      reopened: 'A vertiport or routes are open again',
      booked: 'More passengers want to fly',
      stands: 'A vertiport has gained or lost stands',
      clock: 'Nothing; the clock advances',
    },
    charge: 'Charge of its battery, kWh',
    chargeAsExpected: 'as expected',
    time: 'When it happened',
    now: (time: string) => `now (${time})`,
    send: 'Report',
  },

  whatIf,

  log: {
    many: (events: string) => `${events} events`,
    some: (shown: string, events: string) => `${shown} of ${events} events`,
    search: 'Search',
    clear: 'Clear the filter',
    all: 'all',
    none: 'No matching events.',
    saveTrace: 'Save the trace',
    kept: (number: string) => `The latest ${number} events are kept here; the service has all of them.`,
    event: (seq: number) => `Event ${seq}`,
    takenHint: 'When the service recorded the event, in this computer’s time zone',
    noActor: 'unknown: the service uses no tokens',
    columns: {
      number: 'No.',
      time: 'Time',
      type: 'Type',
      what: 'What happened',
      aircraft: 'Aircraft',
      vertiport: 'Vertiport',
      actor: 'By',
      taken: 'Recorded at',
    },
  },

  events: {
    types: {
      decided: 'decided',
      undone: 'undone',
      departed: 'departed',
      landed: 'landed',
      charging: 'charging',
      ready: 'ready',
      delayed: 'delayed',
      out_of_service: 'out of service',
      back_in_service: 'back in service',
      closed: 'closed',
      reopened: 'reopened',
      demand: 'demand',
      booked: 'booked',
      cancelled: 'cancelled',
      stands: 'stands',
      clock: 'clock',
    },
    decided: (aircraft: string, to: string, insteadOf: string | undefined) =>
      `${aircraft} is to go to ${to}${insteadOf === undefined ? '' : `; the policy would have chosen ${insteadOf}`}`,
    undone: (aircraft: string) => `The decision of ${aircraft} was undone`,
    departed: (aircraft: string, to: string | undefined, passengers: number | undefined) =>
      `${aircraft} has departed${to === undefined ? '' : ` for ${to}`}${passengers === undefined ? '' : ` with ${plural(passengers, 'passenger', 'passengers')}`}`,
    landed: (aircraft: string, at: string | undefined, charge: string | undefined) =>
      `${aircraft} has landed${at === undefined ? '' : ` at ${at}`}${charge === undefined ? '' : ` with ${charge} kWh`}`,
    charging: (aircraft: string, ready: string) => `${aircraft} will be ready at ${ready}`,
    ready: (aircraft: string) => `${aircraft} is ready`,
    delayed: (aircraft: string, until: string) => `${aircraft} is delayed until ${until}`,
    outOfService: (aircraft: string, until: string | undefined) =>
      `${aircraft} is out of service${until === undefined ? '' : ` until ${until}`}`,
    backInService: (aircraft: string) => `${aircraft} is back in service`,
    closed: (routes: string, until: string | undefined) =>
      `${routes} closed${until === undefined ? '' : ` until ${until}`}`,
    reopened: (routes: string) => `${routes} open again`,
    demand: (pairs: number, period: string) =>
      `Demand of ${plural(pairs, 'pair', 'pairs')} in the period from ${period}`,
    booked: (passengers: number, from: string, to: string, period: string) =>
      `${plural(passengers, 'passenger', 'passengers')} more from ${from} to ${to} in the period from ${period}`,
    cancelled: (passengers: number, from: string, to: string, period: string) =>
      `${plural(passengers, 'passenger', 'passengers')} fewer from ${from} to ${to} in the period from ${period}`,
    stands: (vertiport: string, stands: number) => `${vertiport} has ${plural(stands, 'stand', 'stands')}`,
    clock: 'The clock advanced',
    allOf: (vertiport: string) => `All routes of ${vertiport} are`,
    route: (from: string, to: string) => `${from} → ${to} is`,
  },

  aircraft: {
    phases: { standing: 'standing', sent_off: 'dispatched', in_the_air: 'in the air' },
    standing: (at: string, ready: string) => `at ${at}, ready ${ready}`,
    sentOff: (from: string, to: string) => `dispatched from ${from} to ${to}, not departed`,
    inTheAir: (to: string, arrival: string) => `in the air to ${to}, lands ${arrival}`,
    notLanded: (to: string, due: string) => `in the air to ${to}, landing was due at ${due}`,
    charge: (kwh: string, battery: string) => `${kwh} kWh of ${battery}`,
    charges: 'Charge of the aircraft',
    landsWith: (kwh: string) => `lands with ${kwh} kWh`,
    waitsForCharge: (time: string) => `charges until it takes off at ${time}`,
    outOfService: 'out of service',
    outUntil: (time: string) => `out of service until ${time}`,
  },

  map,
  timeline,
  replay,

  editor,
  studies,
}
