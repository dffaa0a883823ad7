//! `designs.csv`: the designs that were played, in this order.

use super::SizeReport;

/// The designs as CSV.
pub(super) fn text(report: &SizeReport) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut head: Vec<String> = vec!["played".to_owned()];
    head.extend(report.dimensions.iter().map(|one| one.member.clone()));
    let rest = [
        "aircraft",
        "stands",
        "chargers",
        "fixed_cost_usd",
        "profit_usd",
        "profit_half_width_95",
        "passengers",
        "spilled_passengers",
        "served_share",
        "ceiling",
        "is_found",
    ];
    head.extend(rest.map(str::to_owned));
    writer.write_record(&head).expect("text is written to memory");
    for (number, design) in report.designs.iter().enumerate() {
        let mut row = vec![number.to_string()];
        row.extend(design.numbers.iter().map(u32::to_string));
        row.extend([
            design.size.aircraft.to_string(),
            design.size.stands.to_string(),
            design.size.chargers.to_string(),
            design.size.fixed_cost_usd.to_string(),
            design.profit_usd.mean.to_string(),
            design.profit_usd.half_width_95.map_or_else(String::new, |half| half.to_string()),
            design.passengers.to_string(),
            design.spilled_passengers.to_string(),
            design.served_share.to_string(),
            design.ceiling.to_string(),
            u8::from(number == report.best).to_string(),
        ]);
        writer.write_record(&row).expect("text is written to memory");
    }
    let bytes = writer.into_inner().expect("text is written to memory");
    String::from_utf8(bytes).expect("only text was written")
}
