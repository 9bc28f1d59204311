//! The articles and books that laws come from.

/// An article, a book, a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Work {
    /// What equations, parameter sets and effects call it.
    pub key: String,
    /// Names and values.
    fields: Vec<(String, String)>,
}

impl Work {
    fn field(&self, name: &str) -> Option<&str> {
        self.fields.iter().find(|(of, _)| of == name).map(|(_, value)| value.as_str())
    }

    fn authors(&self) -> Vec<&str> {
        self.field("author").map_or_else(Vec::new, |names| names.split(" and ").collect())
    }

    /// As it is cited: `Dahl 1968`; without authors, its key stands for them.
    pub fn cited(&self) -> String {
        let family = |name: &&str| name.split(',').next().unwrap_or_default().to_owned();
        let names: Vec<String> = self.authors().iter().map(family).collect();
        let who = match names.as_slice() {
            [] => self.key.clone(),
            [one] => one.clone(),
            [one, other] => format!("{one} and {other}"),
            [one, ..] => format!("{one} et al."),
        };
        [Some(who.as_str()), self.field("year")].into_iter().flatten().collect::<Vec<_>>().join(" ")
    }

    /// In Markdown: authors, title, where it appeared, when, and its DOI.
    pub fn listed(&self) -> String {
        let [authors, title, rest] = self.parts();
        let link = self.doi().map_or_else(String::new, |(doi, address)| format!(". [{doi}]({address})"));
        format!("{authors}*{title}*{rest}{link}")
    }

    /// The DOI and its address.
    pub fn doi(&self) -> Option<(String, String)> {
        let doi = self.field("doi")?;
        let address = doi.replace('(', "%28").replace(')', "%29");
        Some((format!("doi:{doi}"), format!("https://doi.org/{address}")))
    }

    /// What stands before the title, the title, and what stands behind it.
    pub fn parts(&self) -> [String; 3] {
        let authors = match self.authors().as_slice() {
            [] => String::new(),
            names => format!("{}. ", names.join("; ").trim_end_matches('.')),
        };
        let title = self.field("title").unwrap_or_default().to_owned();
        let places = ["journal", "booktitle", "publisher", "institution", "organization"];
        let place =
            places.into_iter().find_map(|name| self.field(name)).map(|place| match self.field("volume") {
                Some(volume) => format!("{place} {volume}"),
                None => place.to_owned(),
            });
        let rest = [place.as_deref(), self.field("number"), self.field("note"), self.field("year")];
        let rest: Vec<&str> = rest.into_iter().flatten().collect();
        let rest = if rest.is_empty() { String::new() } else { format!(". {}", rest.join(", ")) };
        [authors, title, rest]
    }
}

/// The works of a list in BibTeX, a field to a line, in the order of the list.
pub fn works(list: &str) -> Vec<Work> {
    let mut works: Vec<Work> = Vec::new();
    for line in list.lines().map(str::trim) {
        if let Some((_, key)) = line.strip_prefix('@').and_then(|it| it.split_once('{')) {
            works.push(Work { key: key.trim_end_matches(',').into(), fields: Vec::new() });
        } else if let Some((name, value)) = line.split_once(" = {")
            && let Some(work) = works.last_mut()
        {
            let value = value.trim_end_matches(',');
            let value = value.strip_suffix('}').unwrap_or(value).to_owned();
            work.fields.push((name.trim().into(), value));
        }
    }
    works
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_work_is_cited_by_its_authors_and_its_year() {
        let list = "@book{One,\n  author = {Solo, A. B.},\n  title = {A Book},\n  publisher = {House},\n  year = {1999}\n}\n\
                    @article{Two,\n  author = {Uno, A. and Due, B.},\n  title = {On it},\n  journal = {J},\n  volume = {3},\n  \
                    year = {2001},\n  doi = {10.1/a(3)4}\n}\n@manual{None,\n  title = {Guide}\n}\n";
        let works = works(list);
        let cited: Vec<String> = works.iter().map(Work::cited).collect();
        assert_eq!(cited, ["Solo 1999", "Uno and Due 2001", "None"]);
        assert_eq!(works[0].listed(), "Solo, A. B. *A Book*. House, 1999");
        assert_eq!(
            works[1].listed(),
            "Uno, A.; Due, B. *On it*. J 3, 2001. [doi:10.1/a(3)4](https://doi.org/10.1/a%283%294)"
        );
        assert_eq!(works[2].listed(), "*Guide*");
    }

    #[test]
    fn the_list_has_a_field_a_line() {
        for line in strut_physics::LITERATURE.lines().filter(|it| it.contains(" = ")) {
            assert!(line.contains(" = {") && line.trim_end_matches(',').ends_with('}'), "{line}");
        }
    }

    #[test]
    fn every_work_has_a_key_of_its_own_a_title_and_no_latex() {
        let all = works(strut_physics::LITERATURE);
        for work in &all {
            assert!(work.field("title").is_some_and(|it| !it.is_empty()), "{}", work.key);
            assert!(!work.listed().contains(['{', '}', '\\']), "{}", work.listed());
            assert_eq!(all.iter().filter(|it| it.key == work.key).count(), 1, "{}", work.key);
            if let Some(doi) = work.field("doi") {
                let signs = |sign: char| sign.is_ascii_alphanumeric() || "./-():".contains(sign);
                assert!(doi.starts_with("10.") && doi.contains('/') && doi.chars().all(signs), "{doi}");
                assert_eq!(all.iter().filter(|it| it.field("doi") == Some(doi)).count(), 1, "{doi}");
            }
        }
    }
}
