//! Names that people read in lists and in the audit: each character is visible, so that no two
//! names look the same and none changes the text around it.

/// Whether a name has only printed characters: no control characters, and none that is invisible or
/// changes the direction of the text.
pub(crate) fn is_printed(name: &str) -> bool {
    let is_hidden = |character: char| {
        character.is_control()
            || matches!(
                character,
                '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
                    | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}'
            )
    };
    !name.contains(is_hidden)
}

#[cfg(test)]
mod tests {
    use super::is_printed;

    #[test]
    fn names_have_no_hidden_characters() {
        for good in ["anna", "Schicht 2", "\u{e9}lodie", "\u{5b8b}"] {
            assert!(is_printed(good), "{good}");
        }
        for bad in ["an\nna", "anna\t", "\u{1b}[31manna", "an\u{202e}na", "anna\u{200b}", "\u{7f}"]
        {
            assert!(!is_printed(bad), "{bad:?}");
        }
    }
}
