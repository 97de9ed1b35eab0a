"""Words of other programs, of standards and of everyday use for keys of the scene language, in small letters."""

_DRAG, _ADDED = "drag: {normal: ...}", "added_mass: {normal: ...}"
_ALONG, _ADDED_ALONG = "drag: {normal: ..., tangential: ...}", "added_mass: {normal: ..., tangential: ...}"
_WALL = "inner_diameter: the outer_diameter less twice the wall"
_BORE, _OUTER = "inner_diameter", "outer_diameter"

# The word: what to write in its place, which begins with a key.
ALIASES: dict[str, str] = {
    **dict.fromkeys(("od", "diameter", "d", "diam", "outer_dia", "outside_diameter", "do"), _OUTER),
    **dict.fromkeys(("id", "bore", "inner_dia", "inside_diameter", "di"), _BORE),
    **dict.fromkeys(("wall_thickness", "wt", "wallthickness", "thickness", "t_wall", "wall_t"), _WALL),
    **dict.fromkeys(("cd", "cdn", "drag_coefficient", "normaldrag", "cd_normal"), _DRAG),
    **dict.fromkeys(("cdt", "cdax", "axialdrag", "cd_axial", "cd_tangential"), _ALONG),
    **dict.fromkeys(("ca", "can", "cm", "added_mass_coefficient", "ca_normal"), _ADDED),
    **dict.fromkeys(("cat", "caax", "ca_axial"), _ADDED_ALONG),
    **dict.fromkeys(("w", "ws", "weight", "wet_weight", "submergedweight", "weight_in_water"), "submerged_weight"),
    **dict.fromkeys(("m", "massperunitlength", "mass_per_length", "linear_mass", "massdenair", "mass_per_m"), "mass"),
    **dict.fromkeys(("axial_stiffness", "axialstiffness", "ae", "eaaxial"), "EA"),
    **dict.fromkeys(("bending_stiffness", "bendstiffness", "bendingstiffness"), "EI"),
    **dict.fromkeys(("torsional_stiffness", "torsionalstiffness", "gj_torsion", "gip"), "GJ"),
    **dict.fromkeys(("mbr", "minradius", "min_radius", "minimum_bend_radius"), "min_bend_radius"),
    **dict.fromkeys(("mbl", "allowabletension", "allowable_tension", "breaking_load", "tmax"), "max_tension"),
    **dict.fromkeys(("smys", "yield", "sigma_y", "fy", "yield_strength"), "yield_stress"),
    **dict.fromkeys(("smts", "smus", "uts", "fu", "ultimate_strength", "tensile_stress"), "tensile_strength"),
    **dict.fromkeys(("t_corr", "corrosion", "tcorr"), "corrosion_allowance"),
    **dict.fromkeys(("t_fab", "mill_tolerance", "tfab"), "fabrication_tolerance"),
    **dict.fromkeys(("alpha_fab", "alphafab"), "fabrication_factor"),
    **dict.fromkeys(("alpha_u", "alphau"), "material_strength_factor"),
    **dict.fromkeys(("f0", "out_of_roundness", "ovalisation"), "ovality"),
    **dict.fromkeys(("su0", "s_u", "cu", "undrained_shear_strength", "shear_strength"), "su"),
    **dict.fromkeys(("su_grad", "dsu_dz", "rho_su", "su_slope", "gradient", "k_su", "sug"), "su_gradient"),
    **dict.fromkeys(("gamma_sub", "unit_weight", "submerged_weight_of_soil", "gamma_prime"), "submerged_unit_weight"),
    **dict.fromkeys(("young", "youngs_modulus", "young_modulus", "e_modulus"), "E"),
    **dict.fromkeys(("poisson", "poissons_ratio", "v"), "nu"),
    **dict.fromkeys(("waveheight", "wave_height", "significant_wave_height", "height", "h_s", "wavehs"), "Hs"),
    **dict.fromkeys(("peak_period", "period", "t_p", "wavetp"), "Tp"),
    **dict.fromkeys(("h", "hs"), "height"),
    **dict.fromkeys(("t", "tp", "wave_period"), "period"),
    **dict.fromkeys(("direction", "heading", "wave_direction", "dir", "wavedirection"), "direction_deg"),
    **dict.fromkeys(("hang_off_angle", "hangoff_angle", "hangoff", "top_angle"), "hang_off: {angle: ...}"),
    **dict.fromkeys(("top_tension", "pretension", "hang_off_tension"), "hang_off: {tension: ...}"),
    **dict.fromkeys(("pos", "coordinates", "xyz", "location"), "position"),
    **dict.fromkeys(("rho", "waterdensity", "fluid_density", "wtrdnsty", "density_of_water"), "density"),
    **dict.fromkeys(("water_depth", "waterdepth", "wtrdpth", "sea_level", "surface"), "surface_level"),
    **dict.fromkeys(("fluid", "content", "contents_density", "contentsdensity"), "contents: {density: ...}"),
    **dict.fromkeys(("linetype", "line", "pipe", "type", "section"), "line_type"),
    **dict.fromkeys(("numsegs", "n_elements", "nelem", "number_of_elements", "n", "segments"), "elements"),
    **dict.fromkeys(("targetsegmentlength", "element_size", "mesh_size", "dl", "ds"), "element_length"),
    **dict.fromkeys(("l", "unstrlen", "arc_length"), "length"),
    **dict.fromkeys(("dt", "timestep", "step", "dtm", "time_increment"), "time_step"),
    **dict.fromkeys(("t_end", "tend", "simulation_time", "stageduration", "end_time"), "duration"),
    **dict.fromkeys(("k", "kbot", "kb", "normalstiffness", "seabed_stiffness", "ks", "normal_stiffness"), "stiffness"),
    **dict.fromkeys(("mu", "friction_coefficient", "frictioncoefficient", "mu_k"), "friction"),
    **dict.fromkeys(("z", "mudline", "seabed_level"), "level"),
    **dict.fromkeys(("g", "gravitational_acceleration"), "gravity"),
    **dict.fromkeys(("linetypes", "line_type", "sections", "pipes"), "line_types"),
    **dict.fromkeys(("environment", "sea", "ocean"), "water"),
    **dict.fromkeys(("raos", "rao_file", "displacement_raos"), "rao"),
    **dict.fromkeys(("enda", "end_a", "anchor", "bottom"), "start"),
    **dict.fromkeys(("endb", "end_b", "top", "hang_off_point"), "end"),
}


def meant_by(word: str, known: list[str]) -> str:
    """Replacement of a word by a key that is known here; "" where the word is none of these."""
    written = ALIASES.get(word.lower().replace("-", "_").replace(" ", "_"), "")
    return written if written.partition(":")[0] in known else ""
