//! The console is public; its data needs a token.

use vertifleet_core::{Coded as _, Stop};
use vertifleet_serve::{Location, Role, Settings, Tokens, serve};

use crate::api::service;
use crate::running::{Running, folder, settings_for};

#[test]
fn the_console_needs_no_token_and_its_data_does() {
    let (_folder, location) = folder();
    let token = Tokens::open(&location).expect("a store").make("screen", Role::Read);
    token.expect("a token");
    let service = Running::start_at(location);
    let page = ureq::get(&service.url).call().expect("the page");
    let header = |name: &str| page.headers()[name].to_str().expect("text").to_owned();
    assert_eq!(header("content-type"), "text/html; charset=utf-8");
    assert_eq!(header("cache-control"), "no-cache");
    let policy = header("content-security-policy");
    assert!(policy.contains("script-src 'self'") && !policy.contains("unsafe"), "{policy}");
    let text = page.into_body().read_to_string().expect("text");
    let script = text.split('"').find(|text| text.starts_with("/assets/")).expect("a file");
    let file = ureq::get(format!("{}{script}", service.url)).call().expect("the file");
    assert_eq!(file.headers()["cache-control"], "public, max-age=31536000, immutable");
    assert_eq!(service.get("/v1/days").status, 401);
    assert_eq!(service.get("/assets/none.js").status, 404);
    assert_eq!(service.get("/assets/..%2Findex.html").status, 404);
}

#[test]
fn the_content_policy_of_the_console_equals_the_tested_one() {
    let (_folder, service) = service();
    let page = ureq::get(&service.url).call().expect("the page");
    let sent = page.headers()["content-security-policy"].to_str().expect("text");
    let source = include_str!("../../../../web/security.ts");
    let tested = source.split('"').skip(1).step_by(2).collect::<Vec<_>>().join("; ");
    assert_eq!(sent, tested);
}

#[test]
fn a_base_map_of_the_operator_is_named_to_the_console_and_may_be_loaded() {
    let folder = tempfile::tempdir().expect("a folder");
    let with = |address: &str| {
        let settings = settings_for(Location::Folder(folder.path().to_owned()));
        Settings { basemap: Some(address.to_owned()), ..settings }
    };
    let service = Running::start_as(with("https://tiles.example.com:8443/style.json?key=a&b=c"));
    let page = ureq::get(&service.url).call().expect("the page");
    let policy = page.headers()["content-security-policy"].to_str().expect("text").to_owned();
    let from_there = |what: &str| {
        let rule = policy.split("; ").find(|rule| rule.starts_with(what)).expect("a rule");
        rule.ends_with(" https://tiles.example.com:8443")
    };
    assert!(from_there("connect-src") && from_there("img-src"), "{policy}");
    assert!(!from_there("script-src"), "{policy}");
    let text = page.into_body().read_to_string().expect("text");
    let named = r#"content="https://tiles.example.com:8443/style.json?key=a&amp;b=c""#;
    assert!(text.contains(named), "{text}");
    drop(service);
    for wrong in
        ["tiles.pmtiles", "ftp://tiles.example.com/a", "https://me@here/a", "https://a;b/c"]
    {
        let refused = serve(&with(wrong), |_| (), &Stop::default());
        assert_eq!(refused.expect_err(wrong).code().to_string(), "V626", "{wrong}");
    }
}
