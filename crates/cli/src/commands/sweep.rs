//! `vertifleet sweep`: the same days and policies under many settings of a network.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{Outputs, Stop, check_folder};
use vertifleet_optimize::Step;
use vertifleet_progress::Bar;
use vertifleet_report::folder;
use vertifleet_study::comparison::DrawnDays;
use vertifleet_study::competitor::Selection;
use vertifleet_study::make_folder;
use vertifleet_study::sweep::{Design, JOURNAL, Sweep, SweepReport, SweepRequest};

use crate::args::SweepArguments;
use crate::commands::{command, find_network, reads_models, warn_of_demand, warn_unserved_days};
use crate::failure::Failure;
use crate::interrupt::end_study_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &SweepArguments) -> Result<ExitCode, Failure> {
    end_study_on_interrupt()?;
    let (policies, models) = (&arguments.policies, &arguments.models);
    let mut outputs = Outputs::new(arguments.force);
    let network = find_network(&arguments.network, &mut outputs)?;
    reads_models(models.iter().map(|(_, model)| model), &mut outputs);
    outputs.replaces_folder(&arguments.out)?;
    check_folder(&arguments.out, &folder::SWEEP, arguments.force)?;
    let selection = Selection { policies, models, seed: arguments.seed };
    // Ctrl-C ends the program itself; the cells that are finished are on the disk.
    let (never, folder) = (Stop::default(), &arguments.out);
    let request = SweepRequest {
        network: &network,
        factors: arguments.vary.clone(),
        design: match arguments.latin {
            Some(cells) => Design::LatinHypercube { cells, seed: arguments.seed },
            None => Design::Grid,
        },
        selection: &selection,
        drawn: DrawnDays { purpose: arguments.split, first: arguments.seed, days: arguments.days },
        bound_step: arguments.bound.then(|| Step::from_minutes(arguments.step)).transpose()?,
    };
    let mut sweep = Sweep::new(request, &never)?;
    warn_of_demand(&network);
    warn_unserved_days(sweep.first_day()?.as_ref());
    make_folder(folder)?;
    let (done, all) = (sweep.keep_in(&folder.join(JOURNAL), arguments.force)?, sweep.playable());
    if done > 0 {
        eprintln!("{done} of {all} cells were there already");
    }
    let bar = Bar::new(all as u64, "cells");
    bar.already_done(done as u64);
    sweep.run(&never, &|| bar.advance(1))?;
    drop(bar);
    let summary = SweepReport::of(&sweep, command())?;
    let report = vertifleet_report::sweep(&summary, &sweep);
    sweep.write_journal(folder)?;
    let page = folder::write_beside_journal(&report, folder)?;
    print(&if arguments.json { summary.to_json() } else { report.text() })?;
    eprintln!("report: {}", page.display());
    Ok(ExitCode::SUCCESS)
}
