"""Two square markers in a picture: found, their edges refined, their relative pose in the plane fitted."""
