//! Contact of programs that look for it where the sides have moved to.

use std::collections::BTreeMap;

use super::Along;
use crate::vector::dot;

/// How well distances have to follow what moved sides leave, and factors between which they may.
const FOLLOWS: f64 = 0.4;
const FACTORS: [f64; 2] = [0.5, 2.0];

impl Along<'_> {
    /// A remark where the distances at `places` are those of contact on the sides as they have moved; empty elsewhere.
    ///
    /// A node that slides by s along the other side, which lies at the height h = v''·n̂ + g, touches it at h(t + s): along the normal of the side
    /// as it was, it is off by s h'.
    pub(super) fn turned(&self, places: &[usize]) -> String {
        let solution = self.solution;
        let value = |node: usize| solution.candidate.value(node);
        let sites = &solution.sites.list;
        let (mut slopes, mut tangents) = (BTreeMap::<usize, (f64, f64)>::new(), BTreeMap::new());
        for span in solution.sites.spans.iter().filter(|span| span.interface == self.interface) {
            let [a, b] = span.ends;
            let [p, q] = span.ends.map(|site| solution.place(sites[site].first));
            let height = |site: usize| {
                let site = &sites[site];
                site.second.map_or(0.0, |node| dot(value(node), site.normal)) + site.gap
            };
            let slope = (height(b) - height(a)) / span.length;
            let tangent = [0, 1].map(|c| (q[c] - p[c]) / span.length);
            for site in [Some(a), span.middle, Some(b)].into_iter().flatten() {
                let (sum, count) = slopes.entry(site).or_default();
                (*sum, *count) = (*sum + slope, *count + 1.0);
                tangents.insert(site, tangent);
            }
        }
        let (mut product, mut square, mut size, mut pairs) = (0.0, 0.0, 0.0, Vec::new());
        for place in places {
            let (Some((sum, count)), Some(tangent)) = (slopes.get(place), tangents.get(place)) else { continue };
            let (found, expected) = (self.depth(*place), sites[*place].jump(*tangent, value) * sum / count);
            product += found * expected;
            square += expected * expected;
            size += found * found;
            pairs.push((found, expected));
        }
        let factor = product / square;
        let miss: f64 = pairs.iter().map(|(found, expected)| (found - factor * expected).powi(2)).sum();
        if pairs.len() > 2 && (FACTORS[0]..=FACTORS[1]).contains(&factor) && miss.sqrt() <= FOLLOWS * size.sqrt() {
            return "; that is what is left where contact turns with the sides: ask that program for small displacements, or load it less"
                .to_string();
        }
        String::new()
    }
}
