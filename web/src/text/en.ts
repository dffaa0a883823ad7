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
    menu: 'Commands and settings',
    palette: 'Find a command',
    paletteHint: 'Find a command, an aircraft or a vertiport',
    paletteEmpty: 'No matches.',
    help: 'Keys',
    helpSingleKeys:
      'Single keys do something. Switch them off if you speak to your computer or hit keys by accident.',
    licences: 'Licences of what the console is made of',
    close: 'Close',
    cancel: 'Cancel',
    theme: 'Appearance',
    themes: { system: 'As the system', light: 'Light', dark: 'Dark' },
    loading: 'Loading…',
    unknownAddress: (view: string) => `There is no page at this address. This is “${view}” instead.`,
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
    silent: (duration: string) => `No sign for ${duration}`,
    isSilent: 'The service is silent',
    silentHint: 'The service sends a sign of life every two seconds. What you see may be out of date.',
    healing: 'Reconnecting',
    lost: 'Connection lost',
    lostHint:
      'What you see may be out of date. Updates resume when the service is back; nothing that you typed is lost.',
    refused: (why: string) =>
      `What you see is as it was: the service sends no more of this day. It says: ${why}`,
  },

  errors: {
    noAnswer: 'The service does not answer.',
    noAnswerHint: 'Nothing was changed that you do not see. Try again when the connection is back.',
    notPermittedHint: 'The token that you signed in with does not permit this.',
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
    explanation: 'The service asks for a token. It is kept until you close this tab.',
    token: 'Token',
    make: 'An administrator makes one with:',
    signIn: 'Sign in',
    signOut: 'Sign out',
    refused: 'The token is invalid or revoked.',
  },

  days: {
    title: 'Days',
    none: 'There is no day yet.',
    noneHint: 'Make one from a network, or let the simulated operator play one:',
    make: 'New day',
    columns: {
      name: 'Day',
      state: 'State',
      waiting: 'Needs a decision',
      profit: 'Profit so far',
      date: 'Date',
      policy: 'Policy',
      made: 'Made',
    },
    states: { running: 'Running', over: 'Over', archived: 'Archived' },
    waitingUnit: ' aircraft',
    noneWaits: 'none',
    madeHint: (zone: string) => `On the clock of this computer, in the time zone ${zone}`,
    network: 'Network',
    seed: 'Seed',
    seedHint: 'Draws the forecast and where aircraft stand in the morning.',
    policy: 'Policy',
    policyDefault: (policy: string) => `The service's own (${policy})`,
    date: 'Date',
    dateHint: 'Without a date the day has a clock and no calendar.',
    name: 'Name',
    optional: 'optional',
    create: 'Make the day',
    made: (name: string) => `Day ${name} is made.`,
    networkSize: (vertiports: number, aircraft: number) =>
      `${plural(vertiports, 'vertiport', 'vertiports')}, ${plural(aircraft, 'aircraft', 'aircraft')}`,
  },

  day: {
    unreadable: 'This day cannot be shown.',
    backToDays: 'All days',
    archived: 'Archived: nothing about this day can change any more.',
    timeZone: (zone: string) => `Times are those of ${zone}.`,
    aircraft: (id: string) => `Aircraft ${id}`,
    vertiport: (id: string) => `Vertiport ${id}`,
    ownClock: 'the day’s own clock',
    clockOnly: 'The day has no date: times are on its own clock.',
  },

  now: {
    figures: 'The day in figures',
    profit: 'Profit so far',
    sentOff: 'of flights sent off',
    sentOffHint:
      'A flight counts from its decision on, before it departs. If the decision is taken back, it no longer counts.',
    expected: 'Expected',
    expectedBy: (policy: string) => `with ${policy}`,
    expectedHint: (policy: string) => `What the day earns if ${policy} takes every decision from now on.`,
    bound: 'At most from now on',
    boundHint:
      'A proven upper bound on the profit of the whole day, for all decisions that are still open and what is known now. It does not include what earlier decisions could have earned.',
    noBound: 'The rest of the day is too large to be bounded quickly.',
    shareOfBound: (share: string) => `${share} expected`,
    passengers: 'Passengers',
    flights: 'Flights',
    repositioning: (number: number) =>
      number === 0 ? 'none empty' : `${number.toLocaleString('en-US')} empty`,
    loadFactor: (share: string) => `${share} of seats taken`,
    speed:
      'How much faster than real time the day passes, about. Between two events the clock goes on at this speed, for two minutes of the day at most.',
    still: 'stands still',
    stillAwaited: 'This simulated day goes on when the aircraft that wait for a decision have been decided.',
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
    explanation: 'Every aircraft is on the ground, and nothing is left to decide.',
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
    nextCommand: 'Next aircraft that waits',
    formerCommand: 'Former aircraft that waits',
  },

  decision: {
    title: 'Decision',
    none: 'No aircraft waits for a decision. The next one comes up here.',
    asking: (aircraft: string) => `Asking about ${aircraft}…`,
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
    policy: 'Policy that is asked',
    dayPolicy: (policy: string) => `${policy} (the day’s)`,
    newer: (to: string) => `The day has moved on. Now: ${to}.`,
    newerSame: 'The day has moved on, and so have the alternatives.',
    showNewer: 'Show',
    showNewerCommand: 'Show the newer proposal',
    gone: (aircraft: string) => `${aircraft} no longer waits.`,
    goneDecided: (aircraft: string, to: string, who: string) => `${aircraft} was sent to ${to} (${who}).`,
    goOn: 'Next',
    passengers: (number: number) => `${number} ${number === 1 ? 'passenger' : 'passengers'}`,
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
        worth: 'What the choice is worth until the end of the day, at the day’s bid prices, dollars.',
        dollars_per_hour:
          'What the policy compares its choices by: the profit of the flight, dollars an hour.',
        none: 'What the policy compares its choices by: a number without a unit, the higher the better.',
      },
      profit: 'What the flight itself earns.',
      stands: 'Stands that are taken or promised, of all.',
    },
    notConsidered: 'not considered',
    holdHere: 'hold',
    impossible: 'Not possible',
    ruleReasons: {
      out_of_range: (to: string, numbers: string) =>
        `The flight to ${to} takes more energy than the battery holds${numbers}.`,
      no_corridor: (to: string) => `No corridor leads from here to ${to}.`,
      closed: (to: string) => `The route to ${to} is closed.`,
      no_stand_free: (to: string, numbers: string) =>
        `Every stand or charger at ${to} is taken, or kept for an aircraft that is on its way there${numbers}.`,
    },
    why: 'What it is worth',
    worthParts: {
      flight: 'Profit of the flight',
      onward: 'What it can earn from there on',
      stand: 'Price of its stand',
      sum: 'Worth',
      corrected: (policy: string) => `What ${policy} makes of it`,
    },
    reason: 'Reason',
    reasonHint: (to: string) => `Why ${to}? The log keeps it.`,
    reasonMissing: 'Enter a reason, which the log keeps.',
    destination: 'Destination',
    send: 'Override',
    taken: (aircraft: string, to: string) => `${aircraft} flies to ${to}.`,
    takenHold: (aircraft: string, at: string) => `${aircraft} holds at ${at}.`,
    undo: 'Undo',
    undoCommand: 'Undo the latest decision that you took here',
    undone: (aircraft: string) => `The decision of ${aircraft} is taken back.`,
    changed: 'The day has moved on, and the policy now chooses otherwise. Nothing was decided.',
    mayNotDecide: 'You may look at this day, and not decide on it.',
  },

  expected: {
    title: 'Expected next',
    by: (policy: string) => `if ${policy} decides`,
    hold: (at: string) => `holds at ${at}`,
    route: (from: string, to: string) => `${from} → ${to}`,
  },

  decided: {
    title: 'Decided lately',
    none: 'Nothing was decided yet.',
    hold: 'hold',
    you: 'you',
    person: 'a person',
    asAdvised: (policy: string) => `as ${policy} advised`,
    noNameHint:
      'The service asks for no tokens, so it does not know who this was: a person who accepted the advice, or a program.',
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
      ready: 'An aircraft is charged',
      delayed: 'An aircraft is delayed',
      out_of_service: 'An aircraft is out of service',
      back_in_service: 'An aircraft is back in service',
      closed: 'A vertiport or routes are closed',
      reopened: 'A vertiport or routes are open again',
      booked: 'More passengers want to fly',
      stands: 'A vertiport has other stands',
      clock: 'Nothing; the clock goes on',
    },
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
    takenHint: 'When the service took the event, on the clock of this computer',
    noActor: 'not known: the service asks for no tokens',
    columns: {
      number: 'No.',
      time: 'Time',
      type: 'Type',
      what: 'What happened',
      aircraft: 'Aircraft',
      vertiport: 'Vertiport',
      actor: 'By',
      taken: 'Taken at',
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
      `${aircraft} is to go to ${to}${insteadOf === undefined ? '' : `, where the policy would have chosen ${insteadOf}`}`,
    undone: (aircraft: string) => `The decision of ${aircraft} is taken back`,
    departed: (aircraft: string, to: string | undefined, passengers: number | undefined) =>
      `${aircraft} has departed${to === undefined ? '' : ` for ${to}`}${passengers === undefined ? '' : ` with ${plural(passengers, 'passenger', 'passengers')}`}`,
    landed: (aircraft: string, at: string | undefined) =>
      `${aircraft} has landed${at === undefined ? '' : ` at ${at}`}`,
    charging: (aircraft: string, ready: string) => `${aircraft} will be charged at ${ready}`,
    ready: (aircraft: string) => `${aircraft} is charged`,
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
    clock: 'The clock was moved on',
    allOf: (vertiport: string) => `All routes of ${vertiport} are`,
    route: (from: string, to: string) => `${from} → ${to} is`,
  },

  aircraft: {
    phases: { standing: 'standing', sent_off: 'sent off', in_the_air: 'in the air' },
    standing: (at: string, ready: string) => `at ${at}, ready ${ready}`,
    sentOff: (from: string, to: string) => `sent off from ${from} to ${to}, has not departed`,
    inTheAir: (to: string, arrival: string) => `in the air to ${to}, lands ${arrival}`,
    notLanded: (to: string, due: string) => `in the air to ${to}, was to land at ${due}`,
    outOfService: 'out of service',
    outUntil: (time: string) => `out of service until ${time}`,
  },

  map,
  timeline,
  replay,

  editor,
  studies,
}
