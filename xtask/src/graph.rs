//! What refers to what in a program, and what can be reached in it.

use std::collections::VecDeque;

/// A function, or data that may hold addresses of functions.
#[derive(Debug, Clone, Default)]
pub struct Node {
    /// Its names for people; several if the linker put one in the place of others, none for data without a name.
    pub names: Vec<String>,
    /// What it occupies.
    pub bytes: u64,
    /// Whether it is a function.
    pub is_function: bool,
    /// The nodes that it calls, jumps to, or holds the address of.
    pub edges: Vec<usize>,
    /// The ways out of it that cannot be followed, for people.
    pub unknown: Vec<String>,
}

impl Node {
    /// Its first name.
    pub fn name(&self) -> &str {
        self.names.first().map_or("data without a name", String::as_str)
    }

    /// Whether one of its names is this path or ends with it.
    pub fn is_named(&self, path: &str) -> bool {
        self.names.iter().any(|name| name.strip_suffix(path).is_some_and(|rest| rest.is_empty() || rest.ends_with("::")))
    }
}

/// What was reached from the roots.
#[derive(Debug)]
pub struct Reached {
    /// The nodes, nearest first.
    pub order: Vec<usize>,
    /// For each node of the graph the one it was reached through; a root's is itself.
    through: Vec<Option<usize>>,
}

impl Reached {
    /// A shortest way from a root to a node that was reached, both included.
    pub fn path(&self, node: usize) -> Vec<usize> {
        let mut path = vec![node];
        while let Some(before) = self.through[path[path.len() - 1]].filter(|before| *before != path[path.len() - 1]) {
            path.push(before);
        }
        path.reverse();
        path
    }
}

/// Goes through the graph from the roots, not beyond nodes at which to stop.
pub fn reach(nodes: &[Node], roots: &[usize], stop: impl Fn(&Node) -> bool) -> Reached {
    let mut through = vec![None; nodes.len()];
    let mut order = Vec::new();
    let mut waiting = VecDeque::new();
    for root in roots {
        if through[*root].replace(*root).is_none() {
            waiting.push_back(*root);
        }
    }
    while let Some(node) = waiting.pop_front() {
        order.push(node);
        if stop(&nodes[node]) {
            continue;
        }
        for next in &nodes[node].edges {
            if through[*next].is_none() {
                through[*next] = Some(node);
                waiting.push_back(*next);
            }
        }
    }
    Reached { order, through }
}

/// The number of functions on the longest way from the roots, or a node that can come back to itself.
///
/// # Errors
/// The node.
pub fn deepest(nodes: &[Node], roots: &[usize]) -> Result<usize, usize> {
    let mut depths = vec![Depth::Unseen; nodes.len()];
    let mut deepest = 0;
    for root in roots {
        deepest = deepest.max(depth(nodes, *root, &mut depths)?);
    }
    Ok(deepest)
}

#[derive(Debug, Clone, Copy)]
enum Depth {
    Unseen,
    Open,
    Known(usize),
}

fn depth(nodes: &[Node], node: usize, depths: &mut [Depth]) -> Result<usize, usize> {
    match depths[node] {
        Depth::Known(known) => return Ok(known),
        Depth::Open => return Err(node),
        Depth::Unseen => depths[node] = Depth::Open,
    }
    let mut below = 0;
    for next in &nodes[node].edges {
        below = below.max(depth(nodes, *next, depths)?);
    }
    let known = below + usize::from(nodes[node].is_function);
    depths[node] = Depth::Known(known);
    Ok(known)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(name: &str, edges: &[usize]) -> Node {
        Node { names: vec![name.into()], is_function: true, edges: edges.to_vec(), ..Node::default() }
    }

    fn data(edges: &[usize]) -> Node {
        Node { edges: edges.to_vec(), ..Node::default() }
    }

    #[test]
    fn the_way_is_the_shortest_even_if_a_longer_one_comes_first() {
        let nodes = [node("root", &[1, 2]), node("long", &[2]), node("hop", &[3]), node("goal", &[])];
        let reached = reach(&nodes, &[0], |_| false);
        assert_eq!(reached.path(3), [0, 2, 3]);
        assert_eq!(reached.path(0), [0]);
        assert_eq!(deepest(&nodes, &[0]), Ok(4));
    }

    #[test]
    fn what_nothing_refers_to_is_not_reached() {
        let nodes = [node("root", &[1]), node("leaf", &[]), node("other", &[3, 1]), node("goal", &[])];
        assert_eq!(reach(&nodes, &[0], |_| false).order, [0, 1]);
    }

    #[test]
    fn a_cycle_ends_and_is_named() {
        let nodes = [node("root", &[1]), node("ping", &[2]), node("pong", &[1, 3]), node("goal", &[])];
        assert_eq!(reach(&nodes, &[0], |_| false).order, [0, 1, 2, 3]);
        assert_eq!(deepest(&nodes, &[0]), Err(1));
    }

    #[test]
    fn data_leads_on_but_adds_no_depth() {
        let nodes = [node("root", &[1]), data(&[2]), node("goal", &[])];
        assert_eq!(reach(&nodes, &[0], |_| false).path(2), [0, 1, 2]);
        assert_eq!(deepest(&nodes, &[0]), Ok(2));
    }

    #[test]
    fn nothing_beyond_a_stop_is_reached() {
        let nodes = [node("root", &[1]), node("stop", &[2]), node("beyond", &[])];
        assert_eq!(reach(&nodes, &[0], |node| node.is_named("stop")).order, [0, 1]);
    }

    #[test]
    fn a_name_is_met_by_its_last_parts_only() {
        let tick = node("firmware::control::control_tick", &[]);
        assert!(tick.is_named("control_tick"));
        assert!(tick.is_named("control::control_tick"));
        assert!(tick.is_named("firmware::control::control_tick"));
        assert!(!tick.is_named("tick"));
        assert!(!tick.is_named("control"));
    }
}
