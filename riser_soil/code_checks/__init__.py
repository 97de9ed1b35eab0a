"""Code checks: utilisations of riser sections by design codes, from load effects at one section and one instant."""
