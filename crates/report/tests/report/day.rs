//! The page of a day is one file, which contains its pictures, their files and the replay.

use std::sync::Arc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use vertifleet_core::{DaySeed, Network, Stop};
use vertifleet_picture::{PlayedPicture, png};
use vertifleet_report::{DAY_PAGE, account};
use vertifleet_study::account::Account;
use vertifleet_study::{PolicySpec, ResolveFor};

#[test]
fn every_picture_of_the_page_is_a_link_to_its_files() {
    let network = Network::shipped("new-york").expect("shipped");
    let day = Arc::new(network.draw(DaySeed::comparison(3).expect("a seed")));
    let spec = PolicySpec::parse("greedy").expect("a policy");
    let greedy = spec.resolve(None, ResolveFor::Day(&day), 0).expect("it has no weights");
    let (trace, totals) = greedy.play("greedy", &day, &Stop::default()).expect("a whole day");
    let rows = trace.rows.clone();
    let played = Account::of(&day, "greedy", trace, totals);
    let replayed = [played.replayed()];
    let page = account(&played, &replayed).page();
    assert!(page.starts_with(DAY_PAGE.opening), "the program recognises its own pages");
    for picture in PlayedPicture::ALL {
        let svg = picture.draw(&day, &rows);
        assert!(page.contains(&svg), "the picture itself");
        for file in [svg.clone().into_bytes(), png(&svg)] {
            assert!(page.contains(&STANDARD.encode(file)), "{picture:?}");
        }
    }
    assert!(!page.contains("one more stand"), "worth is what an explanation adds");
    let without_replay = page.split("<iframe").next().expect("a beginning");
    for outside in ["src=\"", "href=\"http", "@import", "<script"] {
        assert!(!without_replay.contains(outside), "{outside}");
    }
}
