// Starting points for a network that resembles no existing one. Each is small and complete, and
// states its assumptions.

const OPERATIONS = `[operations]
start = "06:00:00"
end = "20:00:00"                # the last instant at which an aircraft may decide to leave
takeoff_s = 300                 # boarding, taxi and climb
landing_s = 300
hold_s = 600                    # a holding aircraft needs another decision after this time
`

const FLEET = `# assumption: a pilot and 4 passengers, a range of 100 miles.
[[aircraft_types]]
id = "air-taxi"
seats = 4
speed_mph = 150
battery_kwh = 150
energy_kwh_per_mi = 1.5
charge_kw = 180
self_discharge_per_h = 0

[[fleet]]
type = "air-taxi"
count = 8

[tariffs]
passenger_cost_usd_per_mi = 1.5 # pilot, upkeep and landing fees
fare_usd_per_mi = 5
fare_base = 0
fare_demand_weight = 0
energy_price_usd_per_kwh = 0.2
`

const DEMAND = `# assumption: two rush hours. Passengers of a day are distributed by the product of two vertiports' weights.
[daily_demand]
periods = [
    "06:00:00", "07:00:00", "08:00:00", "09:00:00", "10:00:00", "11:00:00", "12:00:00", "13:00:00",
    "14:00:00", "15:00:00", "16:00:00", "17:00:00", "18:00:00", "19:00:00",
]
shares_percent = [5, 9, 11, 7, 5, 5, 6, 6, 6, 7, 10, 11, 8, 4]

[daily_demand.gravity]
passengers = 600
weights = [3, 2, 1]
`

export interface Template {
  /** The key of its title and description in the texts. */
  key: 'city' | 'plane'
  toml: string
}

export const templates: readonly Template[] = [
  {
    key: 'city',
    toml: `# A network of three vertiports with coordinates. Move them, and add more.

format = "vertifleet-network/1"
name = "city"
start_positions = "random"
time_zone = "America/New_York"

${OPERATIONS}
[[vertiports]]
id = "Downtown"
latitude = 40.70112
longitude = -74.00880
stands = 4
busy = true

[[vertiports]]
id = "Airport"
latitude = 40.63993
longitude = -73.77869
stands = 6
busy = true

[[vertiports]]
id = "Suburb"
latitude = 40.85010
longitude = -74.06083
stands = 4
busy = false

${FLEET}
${DEMAND}`,
  },
  {
    key: 'plane',
    toml: `# A network of three vertiports in a plane of miles. Move them, and add more.

format = "vertifleet-network/1"
name = "region"
start_positions = "random"

${OPERATIONS}
[[vertiports]]
id = "Centre"
x_mi = 20
y_mi = 20
stands = 4
busy = true

[[vertiports]]
id = "East"
x_mi = 38
y_mi = 24
stands = 6
busy = true

[[vertiports]]
id = "North"
x_mi = 14
y_mi = 36
stands = 4
busy = false

${FLEET}
${DEMAND}`,
  },
]
