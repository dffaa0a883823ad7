//! Generalised advantage estimation (Schulman et al. 2016), for consecutive decisions of one
//! environment.

/// Fills `advantages` for consecutive decisions of one environment.
///
/// `values[t]` is the value estimated before decision `t`, and `last_value` the one after the last
/// decision. `day_ends[t]` is true if the day was over after decision `t`, so that nothing after it
/// counts.
pub(crate) fn estimate(
    rewards: &[f32],
    values: &[f32],
    day_ends: &[bool],
    last_value: f32,
    gamma: f32,
    lambda: f32,
    advantages: &mut [f32],
) {
    let mut next_value = last_value;
    let mut advantage = 0.0;
    for step in (0..rewards.len()).rev() {
        let goes_on = if day_ends[step] { 0.0 } else { 1.0 };
        let td_error = rewards[step] + gamma * next_value * goes_on - values[step];
        advantage = td_error + gamma * lambda * goes_on * advantage;
        advantages[step] = advantage;
        next_value = values[step];
    }
}

#[cfg(test)]
mod tests {
    use super::estimate;

    #[test]
    fn with_lambda_1_and_gamma_1_the_advantage_is_the_return_less_the_value() {
        let mut advantages = [0.0; 4];
        let values = [0.5, 0.25, 2.0, 1.0];
        estimate(
            &[1.0, 2.0, 3.0, 4.0],
            &values,
            &[false, true, false, false],
            10.0,
            1.0,
            1.0,
            &mut advantages,
        );
        assert_eq!(advantages, [3.0 - 0.5, 2.0 - 0.25, 17.0 - 2.0, 14.0 - 1.0]);
    }

    #[test]
    fn with_lambda_0_the_advantage_is_one_step_of_td_error() {
        let mut advantages = [0.0; 2];
        estimate(&[1.0, 2.0], &[0.5, 0.25], &[false, false], 4.0, 0.5, 0.0, &mut advantages);
        assert_eq!(advantages, [1.0 + 0.5 * 0.25 - 0.5, 2.0 + 0.5 * 4.0 - 0.25]);
    }
}
