//! The result of a study in answers: the numbers of `vertifleet compare --json`, and those of each
//! day.

use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_study::comparison::PolicySummary;
use vertifleet_study::statistics::{self, PairedTest};
use vertifleet_study::{ComparisonReport, Sees};

/// The result of a study. Amounts and counts are means per day.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct StudyResult {
    /// The version of the program that played it.
    program_version: &'static str,
    /// The seed of the first day; the others have the following seeds.
    first_seed: u64,
    /// Upper bound of a day's profit, dollars, if bounds were requested. No schedule earns more; it
    /// is proven, not estimated.
    #[serde(skip_serializing_if = "Option::is_none")]
    upper_bound_usd: Option<Estimate>,
    /// Every policy, in the order of the request.
    policies: Vec<PolicyResult>,
}

/// The result of one policy. Amounts and counts are means per day.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct PolicyResult {
    /// Its name.
    name: String,
    /// A description of the policy.
    description: String,
    /// The information that it uses: `present`, `forecast` or `whole-day`.
    #[schema(value_type = String)]
    sees: Sees,
    /// Profit, dollars.
    profit_usd: Estimate,
    /// Profit as a share of the day's upper bound, if bounds were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    bound_share: Option<Estimate>,
    /// Its lead over the first policy; absent for the first.
    #[serde(skip_serializing_if = "Option::is_none")]
    minus_first: Option<Difference>,
    /// Fares, dollars.
    revenue_usd: f64,
    /// Cost of carrying passengers, dollars.
    passenger_cost_usd: f64,
    /// Cost of energy, dollars.
    energy_cost_usd: f64,
    /// Cost of flights, with or without passengers, dollars.
    flight_cost_usd: f64,
    /// Fixed cost of the fleet, dollars.
    aircraft_cost_usd: f64,
    /// Fixed cost of stands and chargers, dollars.
    site_cost_usd: f64,
    /// Passengers who were carried.
    passengers: f64,
    /// Passengers who were not carried.
    spilled_passengers: f64,
    /// Passenger-miles over seat-miles, 0 to 1.
    load_factor: f64,
    /// Flights, with and without passengers.
    flights: f64,
    /// Flights without passengers.
    repositioning_flights: f64,
    /// Decisions to hold.
    holds: f64,
    /// The profit of each day, dollars, in the order of the days' seeds.
    daily_profit_usd: Vec<f64>,
}

/// A mean with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, ToSchema)]
pub(crate) struct Estimate {
    /// The mean.
    mean: f64,
    /// The sample standard deviation between days; null with one day.
    standard_deviation: Option<f64>,
    /// Half the width of the 95 % interval of the mean (Student's t); null with one day.
    half_width_95: Option<f64>,
}

/// A difference of two policies, day by day: their daily profit, dollars, with the paired t-test of
/// whether its mean is 0.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub(crate) struct Difference {
    /// The difference.
    profit_usd: Estimate,
    /// The p-value: the probability of a difference at least as large as this if there were none
    /// (two-sided); null with one day.
    /// day.
    p_value: Option<f64>,
    /// Days on which it earned more.
    days_ahead: usize,
    /// Days on which it earned less.
    days_behind: usize,
}

impl StudyResult {
    /// The results of a comparison for the policies with these names, the first of which is the
    /// reference.
    pub(super) fn of(report: &ComparisonReport, policies: &[String]) -> Self {
        let named = |name: &String| report.policies.iter().find(|policy| policy.name == *name);
        let policies: Vec<&PolicySummary> = policies.iter().filter_map(named).collect();
        let of = |(position, policy): (usize, &&PolicySummary)| {
            let first = (position > 0).then_some(policies[0]);
            PolicyResult::of(policy, first)
        };
        Self {
            program_version: report.program_version,
            first_seed: report.day_seeds.map_or(0, |(first, _)| first),
            upper_bound_usd: report.bound.map(|bound| bound.upper_bound_usd.into()),
            policies: policies.iter().enumerate().map(of).collect(),
        }
    }
}

impl PolicyResult {
    fn of(policy: &PolicySummary, first: Option<&PolicySummary>) -> Self {
        let minus = |first: &PolicySummary| {
            PairedTest::of(&policy.daily_profit_usd, &first.daily_profit_usd).into()
        };
        Self {
            name: policy.name.clone(),
            description: policy.description.clone(),
            sees: policy.sees,
            profit_usd: policy.profit_usd.into(),
            bound_share: policy.bound_share.map(Into::into),
            minus_first: first.map(minus),
            revenue_usd: policy.revenue_usd,
            passenger_cost_usd: policy.passenger_cost_usd,
            energy_cost_usd: policy.energy_cost_usd,
            flight_cost_usd: policy.flight_cost_usd,
            aircraft_cost_usd: policy.aircraft_cost_usd,
            site_cost_usd: policy.site_cost_usd,
            passengers: policy.passengers,
            spilled_passengers: policy.spilled_passengers,
            load_factor: policy.load_factor,
            flights: policy.flights,
            repositioning_flights: policy.repositioning_flights,
            holds: policy.holds,
            daily_profit_usd: policy.daily_profit_usd.clone(),
        }
    }
}

impl From<statistics::Estimate> for Estimate {
    fn from(estimate: statistics::Estimate) -> Self {
        let statistics::Estimate { mean, standard_deviation, half_width_95 } = estimate;
        Self { mean, standard_deviation, half_width_95 }
    }
}

impl From<PairedTest> for Difference {
    fn from(test: PairedTest) -> Self {
        Self {
            profit_usd: test.difference.into(),
            p_value: test.p_value,
            days_ahead: test.first_larger,
            days_behind: test.second_larger,
        }
    }
}
