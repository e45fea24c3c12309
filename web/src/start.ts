/** The scene that the page opens with: a block that nearly falls, and what keeps it further from its tip. */
export const startText = `title = "A block that nearly falls"

[block]
size_m = 2.0
slenderness_deg = 10.0
restitution = 0.85

[[device]]
kind = "none"

[[device]]
kind = "inerter"
mass_ratio = 0.5

[[device]]
kind = "clutched-pair"
mass_ratio = 0.5

[[ground]]
motion = "sine"
amplitude_m_s2 = 3.5
frequency_hz = 1.25

[run]
free_time_s = 6.0

[map]
x = { key = "ground.0.frequency_hz", from = 0.5, to = 3.0, cells = 128 }
y = { key = "ground.0.amplitude_m_s2", from = 1.0, to = 10.0, cells = 128 }
`;
