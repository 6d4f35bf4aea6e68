"""Faults of designs and of command lines that no rule of one value tells, and what refuses each."""

from pathlib import Path

FINDS = Path(__file__).with_name("finds")

SIZE = "size cross_axis_pivot --objective centre-shift"
SIDES = "width_m = 0.01000320153681966\nthickness_m = 0.0049983997439180475"
MOMENTS = "area_m2 = 5e-5\nsecond_moment_m4 = 1.041e-10\nouter_fibre_m = 0.0025"
LED = 'effects = ["+driven_displacement"]\n[effects.driven_displacement]\ndisplacement_m = [0, 0]\n[strip]'
TOGETHER = '[scene]\neffects = ["+gravity"]\n[drive]\norder = "together"'
TAPER = ("thickness_m =", "thickness_end_m = 0.002\nthickness_m =", "got a taper, expected a constant")
#: Command with its case -> a text of its file, what is written over it, and what the one line must say.
CHANGED = {
    SIZE: [
        TAPER,
        (SIDES, MOMENTS, "strip.outer_fibre_m: got 0.0025, expected none"),
        ("[strip]", f"[scene]\n{LED}", "got driven_displacement, expected a body free to shift"),
        ("[drive]", TOGETHER, 'drive.order: got "together", expected "loads first"'),
    ],
    "advise cross_axis_pivot": [TAPER],
    "solve round_rod": [
        ("[mat", "thickness_end_m = 1\n[mat", "thickness_end_m: got it beside area_m2, expected width_m and"),
        ("[mat", "section_depth_m = 1\n[mat", "section.section_depth_m: got an unknown key"),
        ("outer_fibre_m = 0.004", "section_depth_m = -1", "section.outer_fibre_m: got -0.5, expected a"),
        ("outer_fibre_m = 0.004", "outer_fibre_m = 0", "section.outer_fibre_m: got 0, expected a positive"),
    ],
    "release round_rod": [("[scene]", "[scene] #", "bodies: got none, expected a body whose motion is")],
    "solve cross_axis_pivot": [
        ("[strip]", "x = 1\n[strip]", "x: got a value outside any section, expected one of [strip]"),
        ("[drive]", "[body.drive]", "body.drive: got an unknown key, expected one of mass_kg"),
        ("[strip]", "[strip", "got text that is not TOML"),
        ("= 0.010003", "= 1e-200 #", "strip_1: stiffness EA [N]: got 1.03e-191, expected 1e-60 to 1e+60"),
        ("= 0.010003", "= 1e150 #", "stiffness EA [N]: got 1.03e+159"),
        ("= 0.004998", "= 1e3 #", "slenderness L sqrt(A/I) [1]: got 0.000294"),
        ("= 90 ", f"= 1{'0' * 5000} ", "got a whole number that fills pages, expected a TOML case"),
        ("ts = 20", f"ts = 0x{'f' * 8000}", "drive.increments: got a whole number of about 9633 digits"),
        ("[0, 0]", "[" * 3000 + "]" * 3000, "got lists or tables nested too deep, expected a TOML"),
        ("width_m", "area_m2 = 1\nwidth_m", "strip.width_m: got it beside area_m2, expected width_m"),
        ("width_m = 0.01", "# ", "strip.width_m: got no such key, expected a positive number [m]"),
        ("poisson_ratio = 0.29", "", "material.poisson_ratio: got no such key, expected a number abo"),
        ("[drive]", '[scene]\neffects = ["+strip_drag"]\n[drive]', "strip_drag.rate_per_s: got no such key"),
        ("[drive]", "[effects.gravity]\n[drive]", 'expected [scene] with effects = ["+gravity"] as well'),
    ],
    "converge cross_axis_pivot": [("= 90 ", "= 0 ", "drive.rotation_deg: got 0, expected a rotation")],
    "release four_bar_of_flexures": [
        ("rotation_deg = 20", "held_s = [0, 1]", "drive.rotation_deg: got none, expected the rotation")
    ],
    "solve four_bar_of_flexures": [
        ('"gravity"]', '"gravty"]', "scene.effects: got gravty, expected gravity (the nearest name)"),
        ('["bending"', '"bending" #', 'scene.effects: got the text "bending", expected a list'),
        ('["bending"', '["+bending"', 'gravity", expected +NAME and -NAME, or names alone'),
        ("[drive]", "[effects.applied_moment]\nmoment_Nm = 1\n[drive]", 'expected "applied_moment" in'),
        ("[drive]", "[effects.gravty]\n[drive]", "effects: got gravty, expected gravity"),
        ("[drive]", "[effects]\ngravity = 1\n[drive]", "got 1, expected a table [effects.gravity]"),
        ('tip = "crank"', 'tip = "crnk"', "strips.ground_crank.tip: got crnk, expected crank (the nearest"),
        ('name = "coupler"\n', 'name = "crank"\n', "name: got crank, expected different names"),
        ("[0, 0.02]", "[0, 0]", "crank.end_m: got [0.0, 0.0], where it begins, expected a length"),
        ("width_m = 0.01", "", "ground_crank.width_m: got no such key there nor in [section], expec"),
        ("[section]", "[sektion]", "[sektion]: got an unknown section, expected section (the nearest"),
        ("[section]", "[[section]]", "section: got list, expected a table [section]"),
        ('body = "crank"', "", "drive.body: got no such key, expected one of crank, coupler, rocker"),
        ('body = "crank"', 'body = "lever"', "drive.body: got lever, expected"),
        ("[drive]\nbody", "[drivee]\nbody", "[drivee]: got an unknown section, expected drive"),
    ],
}

#: Whole files that are no design, and what the one line must say.
FILES = {
    "strips = []": "strips: got [], expected tables [[strips]]",
    "strips = [1]": "strips: got [1], expected tables [[strips]]",
    'material = "peek"\n[[strips]]': 'expected a table [material] with name = "peek"',
    "\ud800": "got bytes that are not UTF-8 text, expected a TOML case file",
}

#: Words, CASE the paper's pivot, in a folder with a file `there`; and what the one line must say.
WORDS = {
    "slove": "studies: argument COMMAND: got slove, expected solve (the nearest name)",
    "run fig04_trajectry": "got fig04_trajectry, expected fig04_trajectory (the nearest name)",
    "run": "required: NAME",
    "run fig04_trajectory --results there/results": "cannot be written",
    "solve absent.toml --model fe": "absent.toml: cannot be read (No such file or directory)",
    "solve . --model fe": ".: cannot be read (Is a directory)",
    "solve cross_axis": "got cross_axis, expected cross_axis_pivot (the nearest name), or a file",
    "solve mine": "got mine, expected mine.toml",
    "solve CASE --json there/x.json": "there/x.json: cannot be written",
    "solve CASE --json .": ".: cannot be written",
    "solve CASE --plot a.gif": "expected a file that ends in .svg, .png or .pdf",
    "solve CASE --control-points 3": "control_points: got 3, expected",
    "solve CASE --model fe --elements 0": "elements: got 0, expected",
    "solve CASE --model fe --segments 2": "--segments: got it with --model fe",
    "solve CASE --elements 4": "--elements: got it with --model spline",
    "solve CASE --elemnts 4": "expected --elements (the nearest option)",
    "solve CASE --effects -gravity": "one that begins with - is given as --effects=-...",
    "solve CASE --effects=+gravty": "--effects: got gravty, expected gravity (the nearest name)",
    "solve CASE --effects=+zzz": "--effects: got zzz, expected one of bending, stretching, inextensible,",
    "solve CASE --effects=+bending": "got +bending, expected an effect beside bending, stretching",
    "modes CASE --effects=-gravity": "got -gravity, expected one of bending, stretching, strip_inertia",
    "solve CASE --effects=+gravity,bending": "expected +NAME and -NAME, or names alone",
    "solve CASE --effects=": "--effects: got '', expected +NAME",
    "release CASE --effects=+strip_damping": "strip_damping.relaxation_time_s: got no such key, expected",
    "solve CASE --effects=+inextensible": "got 'stretching and inextensible', expected one of",
    "modes CASE --effects=bending,stretching": "expected one of strip_inertia, section_rotary_inertia,",
    "audit CASE --effects=-strip_inertia,-body_inertia": "expected one of strip_inertia, section_rotary",
    "solve CASE --model fe --effects=bending,inextensible": "effects: got 'inextensible', expected one of",
    "release CASE --integrator generalised-alpha": "expected one of energy, leapfrog",
    "advise parallel_strip_guide": "got none, expected a rotation to relate errors to",
    "converge CASE --elements 5:10": "--elements: got 5:10, expected A:B with A <= 40 and B >= 4 A",
    "converge CASE --elements 5": "got 5, expected FIRST:LAST with 1 <= FIRST < LAST",
    "converge CASE --control-points 3:8": "got 3:8, expected FIRST:LAST with 4 <= FIRST",
    "converge CASE --control-points 8:4": "got 8:4, expected FIRST:LAST",
    "converge CASE --out there/out": "cannot be written",
    "audit CASE --control-points 3": "--control-points: got 3, expected a whole number of at least 4",
    "compare CASE": "expected 2 to 5 designs",
    "compare CASE CASE --model spline,fe,fe-shear": "expected 2 to 5 designs",
    "case --pivot --mechanism": "case: got --pivot and --mechanism, expected one of them",
    "case --out mine.toml": "--out: got mine.toml, which holds something else, expected a new file",
    "sweep mine.toml --out out --workers 2 --scheduler tcp://127.0.0.1:1": "--workers: got it with",
    "solve CASE --export there/out": "cannot be written",
    "solve CASE --export there": "got the file there, expected a folder",
    "modes CASE --export .": "in it, expected a new or empty folder",
}

ASKED = "size CASE --objective centre-shift --rotation-deg 45 --aspect 0.5 --starts 1"
LINKAGE = "size four_bar_of_flexures --objective stress"
HINGE, GUIDE = "size living_hinge --objective", "size parallel_strip_guide --objective"
#: The same of a sizing: also numbers that a case lacks or has no gradients for, and what only other designs
#: have.
WORDS |= {
    "size CASE": "size: the following arguments are required: --objective",
    f"{ASKED} --free strip.width_m=x": "got strip.width_m=x, expected KEY=LOW:HIGH with LOW < HIGH, in the",
    f"{ASKED} --stiffness=--": "argument --stiffness: expected one argument",
    f"{ASKED} --free strip.crossing_ratio=0.5:1.5": "got 1.5, expected a number between 0 and 1",
    f"{ASKED} --out /nowhere/x.toml": "/nowhere/x.toml: cannot be written",
    f"{ASKED} --rotation-deg 0": "drive.rotation_deg: got 0, expected a range to size for",
    f"{HINGE} stress --free section.thickness_m=1e-9:1": "--free: section.thickness_m at its bound of 1: ",
    f"{HINGE} stiffness-variation --free section.width_m": "expected what is not zero already: its stiffness",
    f"{HINGE} centre-shift --free section.width_m": "got centre-shift, expected stiffness-variation or",
    LINKAGE: "--free: got none, expected a number of the mechanism's file",
    f"{LINKAGE} --free section.depth_m": "--free: got section.depth_m, expected a number of",
    f"{LINKAGE} --free strips.rocker_ground.end_m.x": "without bounds, expected strips.rock",
    f"{LINKAGE} --free section.width_m=2:1": "expected KEY=LOW:HIGH with LOW",
    f"{LINKAGE} --free bodies.crank.mass_kg": "expected a number of sections, moduli",
    f"size {FINDS / 'two_bodies_in_series.toml'} --objective stress --free section.thickness_m": (
        "--free: got section.thickness_m, expected one that the design depends on: all strips have"
    ),
    f"size {FINDS / 'half_circle.toml'} --objective stress --free section.area_m2=4e-3:6e-3": (
        "arc of strip beam [deg]: got 180.0, expected at most 100 deg for sensitivities: two strips, a body"
    ),
    f"{LINKAGE} --free section.width_m --travel-mm 1": "--travel-mm: got it for four_bar",
    "size CASE --objective centre-shift --free x": "--free: got x, expected a number of",
    "size CASE --objective centre-shift --travel-mm 1": "--travel-mm: got it for cross_axis",
    f"{GUIDE} stiffness-variation --free section.width_m": "got stiffness-variation, expected stress for",
}
#: Loads that nothing holds.
FREE = (("hub_with_cable", "hub"), ("free_flight", "A"))
WORDS |= {
    f"{verb} {FINDS / name}.toml{more} --model {model}": f"nothing holds body {body}"
    for name, body in FREE
    for verb, more in (("solve", ""), ("critical-load", ""), ("compare", " cross_axis_pivot"))
    for model in ("spline", "fe")
}
