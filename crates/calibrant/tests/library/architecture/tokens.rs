//! The tokens of a source without comments, strings and test code, for the architecture test.

/// Words, numbers, `::` and single signs; a string or a character becomes `"`.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    without_tests(&all(text))
}

fn all(text: &str) -> Vec<String> {
    let signs: Vec<char> = text.chars().collect();
    let at = |place: usize| signs.get(place).copied().unwrap_or('\0');
    let mut found = Vec::new();
    let mut place = 0;
    while place < signs.len() {
        let sign = signs[place];
        if sign == '/' && at(place + 1) == '/' {
            while place < signs.len() && signs[place] != '\n' {
                place += 1;
            }
        } else if sign == '/' && at(place + 1) == '*' {
            place = after_block_comment(&signs, place);
        } else if let Some(end) = after_raw_string(&signs, place) {
            found.push("\"".to_owned());
            place = end;
        } else if sign == '"' {
            found.push("\"".to_owned());
            place = after_quoted(&signs, place, '"');
        } else if sign == '\'' {
            if at(place + 1) == '\\' || at(place + 2) == '\'' {
                found.push("\"".to_owned());
                place = after_quoted(&signs, place, '\'');
            } else {
                place += 1;
                while is_word(at(place)) {
                    place += 1;
                }
            }
        } else if is_word(sign) {
            let start = place;
            while is_word(at(place)) {
                place += 1;
            }
            found.push(signs[start..place].iter().collect());
        } else if sign == ':' && at(place + 1) == ':' {
            found.push("::".to_owned());
            place += 2;
        } else {
            if !sign.is_whitespace() {
                found.push(sign.to_string());
            }
            place += 1;
        }
    }
    found
}

fn is_word(sign: char) -> bool {
    sign.is_alphanumeric() || sign == '_'
}

fn after_block_comment(signs: &[char], start: usize) -> usize {
    let (mut depth, mut place) = (0, start);
    while place < signs.len() {
        match (signs[place], signs.get(place + 1)) {
            ('/', Some('*')) => (depth, place) = (depth + 1, place + 2),
            ('*', Some('/')) => (depth, place) = (depth - 1, place + 2),
            _ => place += 1,
        }
        if depth == 0 {
            break;
        }
    }
    place
}

/// The end of a raw string that starts here: `r"…"`, `r#"…"#`, `br"…"`.
fn after_raw_string(signs: &[char], start: usize) -> Option<usize> {
    let inside_word = start > 0 && is_word(signs[start - 1]);
    let r = start + usize::from(signs[start] == 'b');
    if inside_word || signs.get(r) != Some(&'r') {
        return None;
    }
    let hashes = signs[r + 1..].iter().take_while(|sign| **sign == '#').count();
    let open = r + 1 + hashes;
    if signs.get(open) != Some(&'"') {
        return None;
    }
    let closes = |place: &usize| {
        signs[*place] == '"'
            && signs[place + 1..].iter().take(hashes).filter(|sign| **sign == '#').count() == hashes
    };
    Some((open + 1..signs.len()).find(closes).map_or(signs.len(), |place| place + 1 + hashes))
}

fn after_quoted(signs: &[char], start: usize, quote: char) -> usize {
    let mut place = start + 1;
    while place < signs.len() && signs[place] != quote {
        place += if signs[place] == '\\' { 2 } else { 1 };
    }
    place + 1
}

/// Removes each item that follows `#[cfg(test)]` or `#[test]`.
fn without_tests(tokens: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut place = 0;
    while place < tokens.len() {
        let Some(end) = after_attribute(tokens, place) else {
            kept.push(tokens[place].clone());
            place += 1;
            continue;
        };
        let attribute = &tokens[place..end];
        let has = |word: &str| attribute.iter().any(|token| token == word);
        if has("test") && !has("not") {
            place = after_item(tokens, end);
        } else {
            kept.extend_from_slice(attribute);
            place = end;
        }
    }
    kept
}

fn after_attribute(tokens: &[String], start: usize) -> Option<usize> {
    (tokens[start] == "#" && tokens.get(start + 1)? == "[").then(|| after_group(tokens, start + 1))
}

/// The place behind the bracket that closes the one at `open`.
pub(crate) fn after_group(tokens: &[String], open: usize) -> usize {
    let mut depth = 0_usize;
    for (place, token) in tokens.iter().enumerate().skip(open) {
        match token.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return place + 1;
        }
    }
    tokens.len()
}

/// The place behind an item or a field: behind its `;` or its closing brace, or behind the comma of a field.
fn after_item(tokens: &[String], start: usize) -> usize {
    const OF_ITEMS: [&str; 10] =
        ["fn", "mod", "use", "impl", "struct", "enum", "const", "static", "type", "trait"];
    let is_field = !tokens[start..].iter().take(6).any(|token| OF_ITEMS.contains(&token.as_str()));
    let mut place = start;
    while place < tokens.len() {
        match tokens[place].as_str() {
            "}" => return place,
            "," if is_field => return place + 1,
            ";" => return place + 1,
            "{" => return after_group(tokens, place),
            "(" | "[" => place = after_group(tokens, place),
            _ => place += 1,
        }
    }
    place
}
